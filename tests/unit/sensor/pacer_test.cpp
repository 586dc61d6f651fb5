// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/pacer.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "tests/support/manual_clock.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::int64_t ms = 1'000'000;

TEST(Pacer, plays_in_real_time_from_the_first_event) {
    test::ManualClock clock(5 * ms);
    Pacer pacer(clock, 1);
    EXPECT_TRUE(pacer.wait_until(1'000'000));
    EXPECT_EQ(clock.steady_ns(), 5 * ms);
    EXPECT_TRUE(pacer.wait_until(1'003'000));
    EXPECT_EQ(clock.steady_ns(), 8 * ms);
}

TEST(Pacer, plays_faster_and_slower) {
    for (const double rate : {0.001, 0.5, 4.0, 1000.0}) {
        test::ManualClock clock;
        Pacer pacer(clock, rate);
        pacer.wait_until(0);
        pacer.wait_until(8'000);
        EXPECT_EQ(clock.steady_ns(), static_cast<std::int64_t>(8e6 / rate));
    }
}

TEST(Pacer, as_fast_as_possible_never_waits) {
    test::ManualClock clock;
    Pacer pacer(clock, 0);
    EXPECT_TRUE(pacer.wait_until(0));
    EXPECT_TRUE(pacer.wait_until(1'000'000'000));
    EXPECT_EQ(clock.steady_ns(), 0);
    EXPECT_EQ(pacer.lag_us(), 0);
}

TEST(Pacer, a_new_rate_goes_on_from_the_sensor_time_reached) {
    test::ManualClock clock;
    Pacer pacer(clock, 1);
    pacer.wait_until(0);
    clock.at(4 * ms, [&] { pacer.set_rate(2); });
    pacer.wait_until(10'000);  // 4 ms at 1, then 6 ms of sensor time at 2
    EXPECT_EQ(clock.steady_ns(), 7 * ms);
    EXPECT_EQ(pacer.rate(), 2);
}

TEST(Pacer, from_as_fast_as_possible_to_real_time_starts_where_the_stream_is) {
    test::ManualClock clock;
    Pacer pacer(clock, 0);
    pacer.wait_until(5'000'000);
    pacer.set_rate(1);
    pacer.wait_until(6'000'000);
    EXPECT_EQ(clock.steady_ns(), 0);
    pacer.wait_until(6'001'000);
    EXPECT_EQ(clock.steady_ns(), 1 * ms);
}

TEST(Pacer, a_new_rate_of_0_ends_a_wait_at_once) {
    test::ManualClock clock;
    Pacer pacer(clock, 1);
    pacer.wait_until(0);
    clock.at(4 * ms, [&] { pacer.set_rate(0); });
    EXPECT_TRUE(pacer.wait_until(10'000));
    EXPECT_EQ(clock.steady_ns(), 4 * ms);
}

TEST(Pacer, a_pause_stops_sensor_time_and_nothing_is_skipped_after_it) {
    test::ManualClock clock;
    Pacer pacer(clock, 1);
    pacer.wait_until(0);
    clock.at(4 * ms, [&] { pacer.pause(); });
    clock.at(100 * ms, [&] {
        EXPECT_TRUE(pacer.paused());
        pacer.resume();
    });
    EXPECT_TRUE(pacer.wait_until(10'000));
    EXPECT_EQ(clock.steady_ns(), 106 * ms);
    EXPECT_FALSE(pacer.paused());
}

TEST(Pacer, a_pause_also_holds_what_goes_as_fast_as_possible) {
    test::ManualClock clock;
    Pacer pacer(clock, 0);
    pacer.pause();
    clock.at(9 * ms, [&] { pacer.resume(); });
    EXPECT_TRUE(pacer.wait_until(0));
    EXPECT_EQ(clock.steady_ns(), 9 * ms);
}

TEST(Pacer, measures_its_lag_and_catches_up_without_waiting) {
    test::ManualClock clock;
    Pacer pacer(clock, 1);
    pacer.wait_until(0);
    clock.advance(7 * ms);
    pacer.wait_until(2'000);
    EXPECT_EQ(pacer.lag_us(), 5'000);
    pacer.wait_until(6'000);
    EXPECT_EQ(clock.steady_ns(), 7 * ms);
    EXPECT_EQ(pacer.lag_us(), 1'000);
    pacer.wait_until(8'000);
    EXPECT_EQ(clock.steady_ns(), 8 * ms);
    EXPECT_EQ(pacer.lag_us(), 0);
}

TEST(Pacer, another_stream_begins_at_once_after_a_restart) {
    test::ManualClock clock;
    Pacer pacer(clock, 1);
    pacer.wait_until(5'000'000);
    pacer.restart();
    pacer.wait_until(1'000);
    EXPECT_EQ(clock.steady_ns(), 0);
    pacer.wait_until(2'000);
    EXPECT_EQ(clock.steady_ns(), 1 * ms);
}

TEST(Pacer, tells_the_host_time_of_sensor_times_around_the_present) {
    test::ManualClock clock(0, 1'700'000'000'000 * ms);
    Pacer pacer(clock, 2);
    pacer.wait_until(1'000'000);
    pacer.wait_until(1'010'000);
    EXPECT_EQ(pacer.host_time_ns(1'010'000), 1'700'000'000'000 * ms + 5 * ms);
    EXPECT_EQ(pacer.host_time_ns(1'000'000), 1'700'000'000'000 * ms);
    pacer.set_rate(0);
    EXPECT_EQ(pacer.host_time_ns(0), clock.realtime_ns());
}

TEST(Pacer, stop_ends_a_wait_on_the_system_clock) {
    SystemClock clock;
    Pacer pacer(clock, 1);
    ASSERT_TRUE(pacer.wait_until(0));
    std::thread stopper([&] { pacer.stop(); });
    EXPECT_FALSE(pacer.wait_until(3'600'000'000));
    stopper.join();
    EXPECT_FALSE(pacer.wait_until(0));
}

TEST(Pacer, a_time_beyond_the_clock_waits_instead_of_overflowing) {
    test::ManualClock clock;
    Pacer pacer(clock, 0.001);
    pacer.wait_until(0);
    clock.at(1 * ms, [&] { pacer.stop(); });
    EXPECT_FALSE(pacer.wait_until(1'000'000'000'000'000'000));
}

}  // namespace
}  // namespace pursuit::sensor
