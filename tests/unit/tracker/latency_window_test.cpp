// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/latency_window.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

constexpr std::int64_t s = 1'000'000'000;

TEST(LatencyWindow, forgets_a_stall_after_ten_seconds_and_not_before_five) {
    LatencyWindow window;
    std::int64_t now_ns = 1000 * s;
    window.add(3'000'000, now_ns);
    for (int second = 1; second <= 5; ++second) window.add(100, now_ns += s);
    EXPECT_EQ(window.both().max_us(), 3'000'000);
    for (int second = 6; second <= 10; ++second) window.add(100, now_ns += s);
    EXPECT_EQ(window.both().max_us(), 100);
    EXPECT_EQ(window.both().samples(), 6U);
}

TEST(LatencyWindow, keeps_the_last_there_were_until_others_come) {
    LatencyWindow window;
    window.add(7, 1000 * s);
    window.add(8, 1006 * s);
    EXPECT_EQ(window.both().samples(), 2U);
    window.add(9, 2000 * s);
    EXPECT_EQ(window.both().samples(), 1U);
    EXPECT_EQ(window.both().percentile_us(0.5), 9);
}

}  // namespace
}  // namespace pursuit::tracker
