// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/climb.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pursuit::tracker {
namespace {

/// A hill with its top at (1.5, −0.75) px, 0.02 rad and 20 px/s to the right.
double height(const Coast& coast) {
    const double x = coast.pose.t_px.x() - 1.5;
    const double y = coast.pose.t_px.y() + 0.75;
    const double turned_px = (theta_rad(coast.pose.a) - 0.02) * 50;
    const double faster_px = (coast.velocity.vx_px_s - 20) / 20;
    return -(x * x + y * y + turned_px * turned_px + faster_px * faster_px);
}

TEST(Climb, reaches_the_top_in_place_angle_and_velocity_to_a_quarter_of_a_step) {
    double z = height({});
    const Coast top = climb({}, z, {4, 20, 1.0 / 50}, height);
    EXPECT_NEAR(top.pose.t_px.x(), 1.5, 0.125);
    EXPECT_NEAR(top.pose.t_px.y(), -0.75, 0.125);
    EXPECT_NEAR(theta_rad(top.pose.a), 0.02, 0.125 / 50);
    EXPECT_NEAR(top.velocity.vx_px_s, 20, 2.5);
    EXPECT_EQ(z, height(top));
}

TEST(Climb, stays_where_nothing_near_is_higher) {
    Coast top;
    top.pose.t_px << 1.5, -0.75;
    top.pose.a = rotation(0.02);
    top.velocity.vx_px_s = 20;
    double z = height(top);
    EXPECT_EQ(climb(top, z, {4, 20, 1.0 / 50}, height).pose, top.pose);
    EXPECT_EQ(z, height(top));
}

}  // namespace
}  // namespace pursuit::tracker
