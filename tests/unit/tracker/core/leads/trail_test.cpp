// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/leads/trail.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

constexpr int on_first = 2;
constexpr int on_subsequent = 3;
constexpr double far_px = 20;

TEST(Trail, says_nothing_of_first_events_before_it_has_learnt) {
    const Trail trail;
    EXPECT_EQ(trail.ahead(on_first, 1), 0);
    EXPECT_EQ(trail.ahead(on_first, far_px), 0);
}

TEST(Trail, a_subsequent_event_after_a_long_way_comes_late) {
    Trail trail;
    trail.set_speed(3000);
    for (int i = 0; i < 5000; ++i) trail.learn(on_subsequent, i % 2 == 0 ? 0.5 : 1.5, 0, 1);
    EXPECT_GT(trail.ahead(on_subsequent, 0.5), 0.1);
    EXPECT_LT(trail.ahead(on_subsequent, 1.5), -0.1);
    EXPECT_NEAR(trail.ahead(on_subsequent, 0.5) + trail.ahead(on_subsequent, 1.5), 0, 0.01);
}

TEST(Trail, leaves_slow_edges_to_what_their_contrast_tells) {
    Trail trail;
    trail.set_speed(30);
    EXPECT_NEAR(trail.ahead(on_subsequent, 2), 0, 0.01);
}

TEST(Trail, learns_how_late_the_events_of_disturbed_pixels_come_and_keeps_the_mean) {
    Trail trail;
    constexpr double late_px = -0.5;
    double mean = 0;
    constexpr int events = 40'000;
    for (int i = 0; i < events; ++i) {
        const double way_px = i % 10 == 0 ? 1 : far_px;
        const double told_px = trail.ahead(on_first, way_px);
        // The lead is the mean of all.
        const double true_px = (way_px < far_px ? late_px : 0) - 0.1 * late_px;
        trail.learn(on_first, way_px, true_px - told_px, 1);
        if (i >= events / 2) mean += told_px / (events - events / 2);
    }
    EXPECT_NEAR(trail.ahead(on_first, 1) - trail.ahead(on_first, far_px), late_px, 0.1);
    EXPECT_NEAR(mean, 0, 0.01);
    EXPECT_TRUE(Trail::is_late(on_first, 1));
    EXPECT_FALSE(Trail::is_late(on_first, far_px));
    EXPECT_FALSE(Trail::is_late(on_subsequent, 1));
}

}  // namespace
}  // namespace pursuit::tracker
