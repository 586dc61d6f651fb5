// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/where_to_look.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

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
