// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/clock_steps.hpp"

#include <gtest/gtest.h>

#include "tests/unit/recorder/packet_payload.hpp"

namespace pursuit::recorder {
namespace {

/// A recording: messages at these seconds, packets with the time of their events beside.
struct Recorded {
    double log_s;
    std::optional<double> event_s{};
    std::uint64_t stream_id = 1;
};

/// When they are due, s since the first.
std::vector<double> due_s(const std::vector<Recorded>& messages) {
    constexpr std::int64_t start_ns = 1'700'000'000'000'000'000;
    ClockSteps finder;
    std::vector<std::int64_t> log_times_ns;
    for (const auto& [log_s, event_s, stream_id] : messages) {
        log_times_ns.push_back(start_ns + static_cast<std::int64_t>(log_s * 1e9));
        v1::EventPacket packet;
        packet.stream_id(stream_id);
        packet.base_time_us(static_cast<std::int64_t>(event_s.value_or(0) * 1e6));
        const auto payload = packet_payload(packet);
        finder.take(log_times_ns.back(), event_s ? PacketFields::of(payload) : std::nullopt);
    }
    SteppedTime time(finder.steps());
    std::vector<double> due;
    for (const auto log_time_ns : log_times_ns) {
        due.push_back(static_cast<double>(time.next(log_time_ns) - start_ns) / 1e9);
    }
    return due;
}

TEST(ClockSteps, an_hour_forward_while_events_go_on_is_not_waited_for) {
    EXPECT_EQ(due_s({{0, 5}, {1, 6}, {3602, 7}, {3603, 8}}), (std::vector<double>{0, 1, 1, 2}));
}

TEST(ClockSteps, an_hour_back_does_not_make_the_rest_hurry) {
    EXPECT_EQ(due_s({{0, 5}, {1, 6}, {-3598, 7}, {-3597, 8}}), (std::vector<double>{0, 1, 1, 2}));
}

TEST(ClockSteps, back_and_forth_add_up) {
    EXPECT_EQ(due_s({{0, 5}, {3600, 6}, {3601, 7}, {2, 8}, {3, 9}}),
              (std::vector<double>{0, 0, 1, 1, 2}));
}

TEST(ClockSteps, one_that_another_topic_shows_first_holds_from_there) {
    EXPECT_EQ(due_s({{0, 5}, {1}, {3602}, {3603, 8}}), (std::vector<double>{0, 1, 1, 2}));
}

TEST(ClockSteps, a_pause_of_events_and_all_is_waited_for) {
    EXPECT_EQ(due_s({{0, 5}, {60, 65}}), (std::vector<double>{0, 60}));
}

TEST(ClockSteps, a_pause_before_another_stream_is_waited_for) {
    EXPECT_EQ(due_s({{0, 5}, {60, 0, 2}, {61, 1, 2}}), (std::vector<double>{0, 60, 61}));
}

TEST(ClockSteps, a_slow_stream_and_a_late_message_are_none) {
    EXPECT_EQ(due_s({{0, 5}, {9, 5.01}, {8.5}, {18, 5.02}}), (std::vector<double>{0, 9, 8.5, 18}));
}

TEST(ClockSteps, at_most_so_many_are_remembered) {
    ClockSteps finder;
    for (std::size_t i = 0; i <= 2 * ClockSteps::most_steps; ++i) {
        finder.take(i % 2 == 0 ? INT64_MIN : INT64_MAX / 2, std::nullopt);
        finder.take(0, std::nullopt);
    }
    EXPECT_LE(finder.steps().size(), ClockSteps::most_steps);
}

}  // namespace
}  // namespace pursuit::recorder
