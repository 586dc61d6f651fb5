// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/estimator/pace.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

/// It goes so fast for so long, told every ms.
void go(Pace& pace, double speed_px_s, double for_s) {
    for (double t_s = 0; t_s < for_s; t_s += 0.001) pace.go(0.001, speed_px_s);
}

TEST(Pace, while_nothing_is_known_it_is_the_speed) {
    const Pace pace;
    EXPECT_EQ(pace.px_s(50, 1), 50);
}

TEST(Pace, of_what_goes_on_as_it_went_it_is_the_speed) {
    Pace pace;
    go(pace, 100, 2);
    EXPECT_NEAR(pace.px_s(100, 1), 100, 1e-6);
}

TEST(Pace, of_what_sets_out_it_is_the_speed_at_once) {
    Pace pace;
    go(pace, 10, 2);
    EXPECT_EQ(pace.px_s(100, 1), 100);
}

TEST(Pace, what_turns_back_is_still_taken_for_nearly_as_fast_as_it_went) {
    Pace pace;
    go(pace, 100, 2);
    go(pace, 10, 0.03);
    EXPECT_GT(pace.px_s(10, 1), 80);
}

TEST(Pace, what_has_stood_for_a_second_is_slow) {
    Pace pace;
    go(pace, 100, 2);
    go(pace, 10, 1.2);
    EXPECT_LT(pace.px_s(10, 1), 15);
}

TEST(Pace, where_most_events_are_others_it_is_little_more_than_the_speed) {
    Pace pace;
    go(pace, 100, 2);
    go(pace, 10, 0.03);
    EXPECT_LT(pace.px_s(10, 0.3), 15);
    EXPECT_EQ(pace.px_s(10, 0), 10);
}

TEST(Pace, one_wrong_speed_for_a_millisecond_is_soon_forgotten) {
    Pace pace;
    go(pace, 100, 2);
    pace.go(0.001, 1000);
    EXPECT_LT(pace.px_s(100, 1), 135);
    go(pace, 100, 0.6);
    EXPECT_LT(pace.px_s(100, 1), 102);
}

TEST(Pace, a_new_start_forgets_it) {
    Pace pace;
    go(pace, 100, 2);
    pace.restart();
    EXPECT_EQ(pace.px_s(10, 1), 10);
}

}  // namespace
}  // namespace pursuit::tracker
