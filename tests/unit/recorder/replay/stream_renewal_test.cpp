// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/stream_renewal.hpp"

#include <gtest/gtest.h>

#include "tests/unit/recorder/packet_payload.hpp"

namespace pursuit::recorder {
namespace {

constexpr std::int64_t recorded_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t now_ns = 1'800'000'000'000'000'000;

/// A packet of that stream that was made at recorded_ns.
v1::EventPacket recorded_packet(std::uint64_t stream_id) {
    v1::EventPacket packet;
    packet.stream_id(stream_id);
    packet.host_time_ns(recorded_ns);
    return packet;
}

/// The payload of recorded_packet(), renewed.
std::vector<std::uint8_t> renewed(StreamRenewal& renewal, std::uint64_t stream_id,
                                  std::int64_t log_time_ns = recorded_ns, double rate = 1) {
    const auto original = packet_payload(recorded_packet(stream_id));
    auto payload = original;
    renewal.renew(payload, *PacketFields::of(original), log_time_ns, {now_ns, 0, rate});
    return payload;
}

std::int64_t renewed_host_ns(std::int64_t log_time_ns, double rate) {
    StreamRenewal renewal;
    return PacketFields::of(renewed(renewal, 1, log_time_ns, rate))->host_time_ns();
}

TEST(StreamRenewal, changes_three_fields_and_leaves_the_rest) {
    StreamRenewal renewal(42);
    auto expected = recorded_packet(7);
    expected.stream_id(42);
    expected.host_time_ns(now_ns);
    expected.recorded_host_time_ns(recorded_ns);
    EXPECT_EQ(renewed(renewal, 7), packet_payload(expected));
}

TEST(StreamRenewal, gives_each_recorded_stream_one_new_id_in_the_order_they_come) {
    StreamRenewal renewal(42);
    std::vector<std::uint64_t> ids;
    for (const std::uint64_t recorded : {7U, 3U, 7U, 9U}) {
        ids.push_back(PacketFields::of(renewed(renewal, recorded))->stream_id());
    }
    EXPECT_EQ(ids, (std::vector<std::uint64_t>{42, 43, 42, 44}));
}

TEST(StreamRenewal, keeps_the_way_from_sensor_to_recorder_in_the_time_of_the_replay) {
    EXPECT_EQ(renewed_host_ns(recorded_ns + 8'000'000, 1), now_ns - 8'000'000);
    EXPECT_EQ(renewed_host_ns(recorded_ns + 8'000'000, 4), now_ns - 2'000'000);
    EXPECT_EQ(renewed_host_ns(recorded_ns + 8'000'000, 0), now_ns);
}

TEST(StreamRenewal, takes_no_lag_from_clocks_that_disagree) {
    EXPECT_EQ(renewed_host_ns(recorded_ns - 1, 1), now_ns);
    EXPECT_EQ(renewed_host_ns(recorded_ns + 3'000'000'000, 1), now_ns - 1'000'000'000);
}

}  // namespace
}  // namespace pursuit::recorder
