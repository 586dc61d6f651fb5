// SPDX-License-Identifier: Apache-2.0
// What a track is made of, each by itself: its grip, its tally, its way while it is hidden.
#include <gtest/gtest.h>

#include <cmath>

#include "services/tracker/core/grip.hpp"
#include "services/tracker/core/hidden_way.hpp"
#include "services/tracker/core/tally.hpp"
#include "services/tracker/core/where_to_look.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

constexpr double let_go = 0.33;

/// 10,000 events a second until then, every `sharp_of`-th of them on the contour.
void hold_grip(Grip& grip, std::int64_t from_us, std::int64_t until_us, int sharp_of) {
    for (std::int64_t t_us = from_us, i = 0; t_us < until_us; t_us += 100, ++i) {
        grip.count(i % sharp_of == 0);
        if (grip.is_due()) grip.weigh(t_us, false, let_go);
    }
}

TEST(Grip, is_lost_when_events_have_spoken_against_the_pose_for_60_ms) {
    Grip grip(Contour(test::arrow()));
    hold_grip(grip, 0, 200'000, 1);
    EXPECT_FALSE(grip.is_against());
    EXPECT_GT(grip.fit(), 0.9);
    hold_grip(grip, 200'000, 250'000, 5);
    EXPECT_FALSE(grip.is_lost());
    hold_grip(grip, 250'000, 320'000, 5);
    EXPECT_TRUE(grip.is_lost());
    EXPECT_LT(grip.fit(), 0.3);
}

TEST(Grip, forgives_when_it_is_told_to) {
    Grip grip(Contour(test::arrow()));
    hold_grip(grip, 0, 300'000, 5);
    ASSERT_TRUE(grip.is_lost());
    grip.forgive();
    EXPECT_FALSE(grip.is_against());
}

TEST(Grip, waits_for_some_events_before_it_weighs_them) {
    Grip grip(Contour(test::arrow()));
    EXPECT_FALSE(grip.is_counting());
    grip.count(true);
    EXPECT_TRUE(grip.is_counting());
    EXPECT_FALSE(grip.is_due());
    for (int i = 0; i < 7; ++i) grip.count(i % 2 == 0);
    EXPECT_TRUE(grip.is_due());
    EXPECT_EQ(grip.sharp(), 5);
    EXPECT_EQ(grip.astray(), 3);
    grip.weigh(0, false, let_go);
    EXPECT_FALSE(grip.is_counting());
}

TEST(Going, makes_events_of_what_moves_across_itself_alone) {
    const Outline::Part upright{{10, 0}, {0, 4}};
    const Going to_the_right{Eigen::Matrix2d::Identity(), {100, 0, 0, 0, 0}};
    const Going up{Eigen::Matrix2d::Identity(), {0, 100, 0, 0, 0}};
    const Going turning{Eigen::Matrix2d::Identity(), {0, 0, 2, 0, 0}};
    EXPECT_DOUBLE_EQ(to_the_right.across_px_s(upright, {10, 0}), 400);
    EXPECT_DOUBLE_EQ(up.across_px_s(upright, {10, 0}), 0);
    EXPECT_DOUBLE_EQ(turning.across_px_s(upright, {10, 0}), 0);
    EXPECT_DOUBLE_EQ(turning.across_px_s(upright, {0, 10}), 80);
}

TEST(Tally, learns_how_many_events_a_way_makes) {
    Outline outline{Contour(test::arrow())};
    const Going going{Eigen::Matrix2d::Identity(), {100, 40, 0, 0, 0}};
    Tally tally;
    tally.begin(0);
    for (int i = 1; i <= 400; ++i) {
        tally.begin(i * 20'000);
        for (Outline::Part& part : outline.parts()) {
            part.events = 5 * going.across_px_s(part, part.middle_px) * 0.02;
        }
        tally.learn(outline, going);
    }
    // 2000 events of 5 a px² are remembered, beside 200 of 2 that are usual for a start.
    const double told_per_px2 = (2000.0 + 200) / (2000.0 / 5 + 200.0 / 2);
    const Outline::Part& part = outline.parts().front();
    EXPECT_NEAR(tally.expected_events(going, part, part.middle_px) / part.events, told_per_px2 / 5,
                1e-6);
}

TEST(HiddenWay, goes_on_at_the_velocity_of_the_last_second) {
    HiddenWay way;
    const auto truth = [](std::int64_t t_us) {
        const double t_s = static_cast<double>(t_us) * 1e-6;
        return pose_of(20 + 80 * t_s, 50 - 30 * t_s, 3 + 0.5 * t_s);
    };
    for (std::int64_t t_us = 0; t_us <= 1'000'000; t_us += 16'000) way.learn(t_us, truth(t_us));
    // The last events say that it stands still: it is believed less than the second before.
    way.begin({1'000'000, truth(1'000'000), {}});
    for (std::int64_t t_us = 1'016'000; t_us <= 1'500'000; t_us += 16'000) {
        way.go_on(t_us, 0.016, TransformKind::isometry);
    }
    const Pose last = way.pose_at(1'500'000);
    EXPECT_NEAR((last.t_px - truth(1'500'000).t_px).norm(), 0, 0.01);
    EXPECT_NEAR((way.last().pose.a - truth(way.last().t_us).a).norm(), 0, 1e-3);
}

TEST(HiddenWay, goes_on_as_it_did_where_nothing_was_learnt) {
    HiddenWay way;
    way.begin({0, pose_of(5, 5, 0), {10, 0, 0, 0, 0}});
    EXPECT_NEAR(way.pose_at(1'000'000).t_px.x(), 15, 1e-9);
}

TEST(WhereToLook, is_farther_about_the_longer_a_new_stream_has_left_the_object_adrift) {
    const Geometry geometry{304, 240};
    const Pose last = pose_of(40, 50, 0.2);
    const SearchRange soon = range_adrift(last, 0.1, geometry, true);
    const SearchRange later = range_adrift(last, 0.3, geometry, true);
    const SearchRange at_last = range_adrift(last, 100, geometry, true);
    EXPECT_LT(soon.reach_px, later.reach_px);
    EXPECT_DOUBLE_EQ(at_last.reach_px, 304);
    EXPECT_EQ(at_last.around.t_px, last.t_px);
    EXPECT_EQ(soon.log_scale, 0);
    EXPECT_GT(range_adrift(last, 0, geometry, false).log_scale, 0);
}

TEST(WhereToLook, is_near_a_lost_object_and_farther_about_the_faster_it_went) {
    const SearchRange slow = range_near({0, pose_of(40, 50, 0), {10, 0, 0, 0, 0}}, 0.2, true);
    const SearchRange fast = range_near({0, pose_of(40, 50, 0), {400, 0, 3, 0, 0}}, 0.2, true);
    EXPECT_EQ(slow.around.t_px.x(), 40);
    EXPECT_GT(fast.reach_px, slow.reach_px);
    EXPECT_GT(fast.angle_rad, slow.angle_rad);
    EXPECT_LE(fast.reach_px, 80);
}

}  // namespace
}  // namespace pursuit::tracker
