// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/where_to_look.hpp"

#include <gtest/gtest.h>

#include "tests/unit/tracker/core/scene.hpp"

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

TEST(WhereToLook, is_in_any_rotation_where_nothing_is_known_of_how_the_object_lies) {
    const Coast own{50'000, pose_of(100, 90, 0.3), {}};
    Doubt doubt;
    doubt.begin(0, 2, 0);
    EXPECT_LT(range_of_check(50'000, own, doubt, own.pose, 0.5).angle_rad, 1);
    doubt.leave_angle_open();
    EXPECT_GE(range_of_check(50'000, own, doubt, own.pose, 0.5).angle_rad, 3.14);
    doubt.begin(0, 2, 0);
    EXPECT_LT(range_of_check(50'000, own, doubt, own.pose, 0.5).angle_rad, 1);
}

TEST(WhereToLook, is_near_a_lost_object_and_farther_about_the_faster_it_went) {
    const SearchRange slow = range_near({0, pose_of(40, 50, 0), {10, 0, 0, 0, 0}}, 0.2, true);
    const SearchRange fast = range_near({0, pose_of(40, 50, 0), {400, 0, 3, 0, 0}}, 0.2, true);
    EXPECT_EQ(slow.around.t_px.x(), 40);
    EXPECT_GT(fast.reach_px, slow.reach_px);
    EXPECT_GT(fast.angle_rad, slow.angle_rad);
    EXPECT_LE(fast.reach_px, 80);
}

TEST(WhereToLook, is_by_turns_for_a_shape_as_drawn_out_as_it_was_when_it_was_last_believed) {
    Eigen::Matrix2d stretched = rotation(0.9);
    stretched.col(1) *= 1.3;
    const Coast own{50'000, {{100, 90}, stretched}, {}};
    const Pose known = pose_of(110, 95, 0.2, 1.1, 1.1);
    Doubt doubt;
    doubt.begin(0, 3, 0);
    const SearchRange first = range_of_check(50'000, own, doubt, known, 0.5);
    EXPECT_EQ(first.around, own.pose);
    static_cast<void>(doubt.take(50'000, {}));
    const SearchRange second = range_of_check(60'000, own, doubt, known, 0.5);
    EXPECT_EQ(second.around.t_px, own.pose.t_px);
    EXPECT_LT((second.around.a - 1.1 * rotation(0.9)).norm(), 1e-12);
    EXPECT_EQ(second.seeds.front(), own.pose);
}

TEST(WhereToLook, is_also_where_a_stretched_shape_would_keep_its_middle_or_one_of_its_ends) {
    const Contour contour(test::polygon("box", {{-20, -30}, {20, -30}, {20, 30}, {-20, 30}}));
    const Pose own = pose_of(100, 90, 0.7, 1.1, 0.8);
    const std::vector<Pose> poses = stretched_poses(contour, own);
    EXPECT_EQ(poses.size(), 24U);
    for (const Pose& pose : poses) {
        const int axis = (pose.a.col(0) - own.a.col(0)).norm() > 1e-9 ? 0 : 1;
        const double by = pose.a.col(axis).norm() / own.a.col(axis).norm();
        EXPECT_TRUE(by > 0.7 && by < 1.4 && std::abs(by - 1) > 0.1) << by;
        EXPECT_LT((pose.a.col(1 - axis) - own.a.col(1 - axis)).norm(), 1e-12);
        int kept = 0;
        for (const double end_px : {-1.0, 0.0, 1.0}) {
            const double m = end_px * (axis == 0 ? 20 : 30);
            const Eigen::Vector2d before = own.t_px + own.a.col(axis) * m;
            const Eigen::Vector2d after = pose.t_px + pose.a.col(axis) * m;
            kept += (after - before).norm() < 1e-9 ? 1 : 0;
        }
        EXPECT_EQ(kept, 1);
    }
}

}  // namespace
}  // namespace pursuit::tracker
