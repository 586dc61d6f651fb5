// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/good_poses.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

PoseRecord known(std::int64_t t_us, double x_px, double vx_px_s, double of_vx) {
    PoseRecord record;
    record.t_us = t_us;
    record.pose = pose_of(x_px, 0, 0);
    record.velocity.vx_px_s = vx_px_s;
    record.velocity.omega_rad_s = 1;
    record.velocity_covariance = {of_vx, 0, 0, 0, 0, 4};
    return record;
}

TEST(GoodPoses, coast_from_the_one_before_the_last) {
    GoodPoses good;
    good.begin_at(pose_of(0, 0, 0), {});
    EXPECT_TRUE(good.is_due(5));
    good.add(known(1'000, 1, 50, 1));
    EXPECT_EQ(good.before().pose.t_px.x(), 1);  // the only one
    EXPECT_FALSE(good.is_due(30'999));
    EXPECT_TRUE(good.is_due(31'000));
    good.add(known(31'000, 2, 50, 1));
    EXPECT_EQ(good.before().pose.t_px.x(), 1);
    good.add(known(61'000, 3, 50, 1));
    EXPECT_EQ(good.before().pose.t_px.x(), 2);
    EXPECT_EQ(good.before().t_us, 31'000);
}

TEST(GoodPoses, do_not_coast_at_a_velocity_that_is_less_than_its_uncertainty) {
    GoodPoses good;
    good.add(known(1'000, 1, 50, 51.0 * 51));
    EXPECT_EQ(good.before().velocity.vx_px_s, 0);
    EXPECT_EQ(good.before().velocity.omega_rad_s, 0);
    good.set({0, pose_of(0, 0, 0), {}});
    good.add(known(31'000, 1, 50, 49.0 * 49));
    good.add(known(61'000, 2, 50, 49.0 * 49));
    EXPECT_EQ(good.before().velocity.vx_px_s, 50);
}

TEST(GoodPoses, coast_from_the_moment_of_loss_where_there_was_none) {
    GoodPoses good;
    good.begin_at(pose_of(7, 0, 0), {});
    good.coast_from(5'000);
    EXPECT_EQ(good.before().t_us, 5'000);
    EXPECT_EQ(good.before().pose.t_px.x(), 7);
    good.coast_from(9'000);
    EXPECT_EQ(good.before().t_us, 5'000);
}

}  // namespace
}  // namespace pursuit::tracker
