// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/packet_fields.hpp"

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <gtest/gtest.h>

#include "events.h"
#include "services/recorder/stream_gaps.hpp"
#include "tests/unit/recorder/packet_payload.hpp"

namespace pursuit::recorder {
namespace {

using eprosima::fastcdr::Cdr;

v1::EventPacket packet_of(std::size_t words) {
    v1::EventPacket packet;
    packet.sensor_id(0x01020304);
    packet.stream_id(0x1112131415161718);
    packet.sequence_number(0x2122232425262728);
    packet.base_time_us(1'000'000);
    packet.host_time_ns(0x3132333435363738);
    packet.recorded_host_time_ns(0x4142434445464748);
    packet.width(304);
    packet.height(240);
    packet.end_of_stream(true);
    packet.dropped_events(0x5152535455565758);
    for (std::uint64_t i = 0; i < words; ++i) packet.words().push_back((100 + i) << 32 | i);
    return packet;
}

v1::EventPacket deserialized(std::vector<std::uint8_t> payload) {
    eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload.data()), payload.size());
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    cdr.read_encapsulation();
    v1::EventPacket packet;
    packet.deserialize(cdr);
    return packet;
}

class PacketFieldsOf : public ::testing::TestWithParam<Cdr::Endianness> {};
INSTANTIATE_TEST_SUITE_P(EitherByteOrder, PacketFieldsOf,
                         ::testing::Values(Cdr::LITTLE_ENDIANNESS, Cdr::BIG_ENDIANNESS));

TEST_P(PacketFieldsOf, a_packet_are_those_that_were_serialized) {
    for (const std::size_t words : {0U, 1U, 2U, 8000U}) {
        const auto payload = packet_payload(packet_of(words), GetParam());
        const auto fields = PacketFields::of(payload);
        ASSERT_TRUE(fields) << words;
        EXPECT_EQ(fields->sensor_id(), 0x01020304U);
        EXPECT_EQ(fields->stream_id(), 0x1112131415161718U);
        EXPECT_EQ(fields->sequence_number(), 0x2122232425262728U);
        EXPECT_EQ(fields->base_time_us(), 1'000'000);
        EXPECT_EQ(fields->host_time_ns(), 0x3132333435363738);
        EXPECT_EQ(fields->recorded_host_time_ns(), 0x4142434445464748);
        EXPECT_EQ(fields->words(), words);
        const auto last = static_cast<std::int64_t>(words) - 1;
        EXPECT_EQ(fields->first_us(), words == 0 ? 1'000'000 : 1'000'100);
        EXPECT_EQ(fields->reached_us(), words == 0 ? 1'000'000 : 1'000'100 + last);
    }
}

TEST_P(PacketFieldsOf, a_packet_are_set_without_touching_the_others) {
    auto expected = packet_of(3);
    auto payload = packet_payload(expected, GetParam());
    const auto original = payload;
    const auto fields = PacketFields::of(original);
    ASSERT_TRUE(fields);
    fields->set_stream_id(payload, 42);
    fields->set_host_time_ns(payload, -43);
    fields->set_recorded_host_time_ns(payload, 44);
    expected.stream_id(42);
    expected.host_time_ns(-43);
    expected.recorded_host_time_ns(44);
    EXPECT_EQ(deserialized(payload), expected);
    EXPECT_EQ(payload, packet_payload(expected, GetParam()));
}

TEST_P(PacketFieldsOf, a_payload_cut_anywhere_are_refused) {
    const auto payload = packet_payload(packet_of(2), GetParam());
    for (std::size_t size = 0; size < payload.size(); ++size) {
        EXPECT_FALSE(PacketFields::of(std::span(payload).first(size))) << size;
    }
    EXPECT_TRUE(PacketFields::of(payload));
}

TEST(PacketFields, of_another_encapsulation_are_refused) {
    auto payload = packet_payload(packet_of(1), Cdr::LITTLE_ENDIANNESS);
    payload[1] = 3;
    EXPECT_FALSE(PacketFields::of(payload));
}

TEST(StreamGaps, counts_jumps_within_a_stream_and_not_where_one_begins) {
    StreamGaps gaps;
    for (const std::uint64_t number : {5, 6, 7}) EXPECT_FALSE(gaps.take(0, 1, number));
    EXPECT_FALSE(gaps.take(0, 2, 100));
    EXPECT_FALSE(gaps.take(1, 1, 50));
    EXPECT_TRUE(gaps.take(0, 1, 10));
    EXPECT_FALSE(gaps.take(0, 1, 9));  // late: no second gap
    EXPECT_FALSE(gaps.take(0, 1, 11));
    EXPECT_EQ(gaps.gaps(), 1U);
    EXPECT_EQ(gaps.missed(), 2U);
}

TEST(StreamGaps, remembers_no_more_than_1024_streams) {
    StreamGaps gaps;
    for (std::uint64_t stream = 1; stream <= 1024; ++stream) EXPECT_FALSE(gaps.take(0, stream, 5));
    EXPECT_TRUE(gaps.take(0, 1, 10));
    EXPECT_FALSE(gaps.take(0, 1025, 5));
    EXPECT_FALSE(gaps.take(0, 1, 20)) << "the first was forgotten for the last";
    EXPECT_TRUE(gaps.take(0, 1, 30)) << "and is remembered again";
}

}  // namespace
}  // namespace pursuit::recorder
