// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/hidden_way.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pursuit::tracker {
namespace {

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

TEST(HiddenWay, knows_how_it_goes_as_a_rule_when_it_was_seen_for_a_while) {
    HiddenWay way;
    std::int64_t t_us = 0;
    const auto learn_until = [&](std::int64_t until_us) {
        for (; t_us < until_us; t_us += 16'000) {
            const double t_s = static_cast<double>(t_us) * 1e-6;
            way.learn(t_us, pose_of(20 + 80 * t_s, 50, 3 + 0.5 * t_s));
        }
    };
    learn_until(200'000);
    EXPECT_FALSE(way.usual().is_known());
    learn_until(1'000'000);
    ASSERT_TRUE(way.usual().is_known());
    EXPECT_NEAR(way.usual().velocity.vx_px_s, 80, 0.01);
    EXPECT_NEAR(way.usual().velocity.omega_rad_s, 0.5, 1e-4);
}

TEST(HiddenWay, strays_the_more_from_the_usual_the_more_it_did) {
    const auto strays_px_s = [](double sway_px) {
        HiddenWay way;
        for (std::int64_t t_us = 0; t_us < 2'000'000; t_us += 16'000) {
            const double t_s = static_cast<double>(t_us) * 1e-6;
            way.learn(t_us, pose_of(80 * t_s, sway_px * std::sin(6 * t_s), 0));
        }
        return way.usual().strays_px_s;
    };
    // It sways at 12 px/s at most.
    EXPECT_GT(strays_px_s(2), strays_px_s(0) + 1.5);
    EXPECT_LT(strays_px_s(2), strays_px_s(0) + 12);
    EXPECT_LT(strays_px_s(0), 0.05 * 80);
}

TEST(HiddenWay, takes_being_found_elsewhere_for_no_way) {
    HiddenWay way;
    const auto stand = [&](double x_px, std::int64_t from_us, std::int64_t to_us) {
        for (std::int64_t t_us = from_us; t_us < to_us; t_us += 16'000) {
            way.learn(t_us, pose_of(x_px, 100, 0));
        }
    };
    stand(50, 0, 2'000'000);
    way.learn_anew();
    EXPECT_FALSE(way.usual().is_known());
    stand(150, 2'500'000, 3'000'000);
    ASSERT_TRUE(way.usual().is_known());
    EXPECT_NEAR(way.usual().velocity.vx_px_s, 0, 1e-9);
    EXPECT_LT(way.usual().strays_px_s, 0.5);
}

TEST(HiddenWay, knows_its_last_way_under_another_while_it_learns_anew) {
    HiddenWay way;
    way.begin({0, pose_of(5, 5, 0), {10, 0, 0, 0, 0}});
    way.learn_anew();
    EXPECT_EQ(way.last().velocity.vx_px_s, 10);
}

TEST(HiddenWay, goes_on_as_it_did_where_nothing_was_learnt) {
    HiddenWay way;
    way.begin({0, pose_of(5, 5, 0), {10, 0, 0, 0, 0}});
    EXPECT_NEAR(way.pose_at(1'000'000).t_px.x(), 15, 1e-9);
}

}  // namespace
}  // namespace pursuit::tracker
