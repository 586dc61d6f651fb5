// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/report/film.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace pursuit::ctl {
namespace {

TEST(Film, the_pose_shown_is_the_last_one_before) {
    std::vector<ReportPose> poses(3);
    for (int i = 0; i < 3; ++i) poses[static_cast<std::size_t>(i)].t_us = i * 1000;
    EXPECT_EQ(pose_at(poses, -1), nullptr);
    EXPECT_EQ(pose_at(poses, 0), &poses[0]);
    EXPECT_EQ(pose_at(poses, 1999), &poses[1]);
    EXPECT_EQ(pose_at(poses, 99'999), &poses[2]);
    EXPECT_EQ(pose_at({}, 5), nullptr);
}

}  // namespace
}  // namespace pursuit::ctl
