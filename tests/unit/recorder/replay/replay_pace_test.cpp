// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/replay_pace.hpp"

#include <gtest/gtest.h>

#include "tests/support/manual_clock.hpp"

namespace pursuit::recorder {
namespace {

constexpr std::int64_t ms = 1'000'000;

class Pace : public ::testing::Test {
 protected:
    /// When the message of that log time is sent, ms since the start.
    std::int64_t sent_ms(ReplayPace& pace, std::int64_t log_ms) {
        const auto due = pace.wait(log_ms * ms);
        return due ? clock_.steady_ns() / ms : -1;
    }
    test::ManualClock clock_{0, 1'700'000'000'000'000'000};
};

TEST_F(Pace, begins_with_the_first_message_whatever_its_time) {
    ReplayPace pace(clock_, 1);
    EXPECT_EQ(sent_ms(pace, 123'456), 0);
    EXPECT_EQ(sent_ms(pace, 123'466), 10);
}

TEST_F(Pace, divides_by_the_rate) {
    ReplayPace pace(clock_, 4);
    EXPECT_EQ(sent_ms(pace, 1000), 0);
    EXPECT_EQ(sent_ms(pace, 1400), 100);
}

TEST_F(Pace, of_rate_zero_never_waits) {
    ReplayPace pace(clock_, 0);
    EXPECT_EQ(sent_ms(pace, 1000), 0);
    EXPECT_EQ(sent_ms(pace, 900'000), 0);
}

TEST_F(Pace, catches_up_after_a_delay_and_says_how_late_it_is) {
    ReplayPace pace(clock_, 1);
    pace.wait(0);
    clock_.advance(50 * ms);
    const auto due = pace.wait(10 * ms);
    ASSERT_TRUE(due);
    EXPECT_EQ(due->late_ns, 40 * ms);
    EXPECT_EQ(due->realtime_ns, 1'700'000'000'000'000'000 + 10 * ms);
    EXPECT_EQ(sent_ms(pace, 60), 60);
}

TEST_F(Pace, stands_still_while_paused) {
    ReplayPace pace(clock_, 1);
    pace.wait(0);
    clock_.at(30 * ms, [&] { pace.pause(true); });
    clock_.at(530 * ms, [&] { pace.pause(false); });
    EXPECT_EQ(sent_ms(pace, 100), 600);
}

TEST_F(Pace, goes_on_from_where_it_is_when_the_rate_changes) {
    ReplayPace pace(clock_, 1);
    pace.wait(0);
    clock_.at(40 * ms, [&] { pace.set_rate(2); });
    EXPECT_EQ(sent_ms(pace, 100), 70);  // 40 ms at 1, the other 60 at 2
    pace.set_rate(0);
    EXPECT_EQ(sent_ms(pace, 500), 70);
    pace.set_rate(1);
    EXPECT_EQ(sent_ms(pace, 510), 80);
}

TEST_F(Pace, gives_nothing_once_stopped) {
    ReplayPace pace(clock_, 1);
    pace.wait(0);
    clock_.at(5 * ms, [&] { pace.stop(); });
    EXPECT_FALSE(pace.wait(1000 * ms));
    EXPECT_EQ(clock_.steady_ns(), 5 * ms);
}

TEST_F(Pace, begins_anew_after_restart) {
    ReplayPace pace(clock_, 1);
    pace.wait(1000 * ms);
    pace.wait(1010 * ms);
    pace.restart();
    EXPECT_EQ(sent_ms(pace, 1000), 10);
    EXPECT_EQ(sent_ms(pace, 1005), 15);
}

}  // namespace
}  // namespace pursuit::recorder
