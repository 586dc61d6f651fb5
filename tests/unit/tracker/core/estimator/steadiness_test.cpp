// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/estimator/steadiness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pursuit::tracker {
namespace {

using Steady = Steadiness<3>;
constexpr double step_px = 0.05;
constexpr double usual_change = 4;

/// So far it goes, its twist corrected at every step by this σ at random, in units of the usual.
void wander(Steady& steadiness, double px, double of_usual, Steady::Step& twist,
            double most_share = 1) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0, of_usual * std::sqrt(usual_change));
    for (double gone_px = 0; gone_px < px; gone_px += step_px) {
        steadiness.begin(twist);
        for (int i = 0; i < 3; ++i) twist(i) += normal(random);
        steadiness.go(step_px, 0, twist, Steady::Step::Constant(usual_change), most_share);
    }
}

TEST(Steadiness, all_of_the_usual_change_is_expected_while_nothing_is_known) {
    const Steady steadiness;
    EXPECT_EQ(steadiness.share(), Steady::Step::Ones());
}

TEST(Steadiness, little_is_expected_of_what_goes_on_as_it_went) {
    Steady steadiness;
    Steady::Step twist(1000, 0, 0);
    wander(steadiness, 100, 0.05, twist);
    EXPECT_LT(steadiness.share().maxCoeff(), 0.1);
    EXPECT_GT(steadiness.share().minCoeff(), 0);
}

TEST(Steadiness, the_usual_is_expected_of_what_wanders_as_much_as_usual) {
    Steady steadiness;
    Steady::Step twist(1000, 0, 0);
    wander(steadiness, 100, 1, twist);
    EXPECT_GT(steadiness.share().mean(), 0.5);
}

TEST(Steadiness, more_than_the_usual_is_expected_where_it_may_be_and_is) {
    Steady steadiness;
    Steady::Step twist(1000, 0, 0);
    wander(steadiness, 100, 3, twist);
    EXPECT_LE(steadiness.share().maxCoeff(), 1);
    wander(steadiness, 100, 3, twist, 8);
    EXPECT_GT(steadiness.share().mean(), 3);
    EXPECT_LE(steadiness.share().maxCoeff(), 8);
    wander(steadiness, 100, 0.05, twist, 8);
    EXPECT_LT(steadiness.share().maxCoeff(), 0.2);
}

TEST(Steadiness, a_turn_is_expected_again_within_part_of_a_pixel) {
    Steady steadiness;
    Steady::Step twist(1000, 0, 0);
    wander(steadiness, 100, 0.05, twist);
    const Steady::Step before = steadiness.share();
    for (int i = 0; i < 10; ++i) {
        steadiness.begin(twist);
        twist(0) -= 10;
        steadiness.go(step_px, 0, twist, Steady::Step::Constant(usual_change));
    }
    EXPECT_GT(steadiness.share()(0), 0.9);
    EXPECT_LE(steadiness.share()(2), before(2)) << "it has not turned about itself";
}

TEST(Steadiness, a_velocity_that_turns_with_the_object_is_steady) {
    Steady steadiness;
    constexpr double angle_rad = 0.002;
    Steady::Step twist(1000, 0, 40);
    for (int i = 0; i < 3000; ++i) {
        steadiness.begin(twist);
        const double vx = twist(0);
        twist(0) -= angle_rad * (twist(1) + angle_rad / 2 * vx);
        twist(1) += angle_rad * (vx - angle_rad / 2 * twist(1));
        steadiness.go(step_px, angle_rad, twist, Steady::Step::Constant(usual_change));
    }
    EXPECT_LT(steadiness.share().maxCoeff(), 0.1);
}

}  // namespace
}  // namespace pursuit::tracker
