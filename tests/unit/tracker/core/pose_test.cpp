// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pursuit::tracker {
namespace {

TEST(Pose, gives_back_angle_and_scales_it_was_made_of) {
    for (double angle_rad = -3.1; angle_rad < 3.1; angle_rad += 0.31) {
        const Pose pose = pose_of(3, 4, angle_rad, 0.8, 1.7);
        EXPECT_NEAR(theta_rad(pose.a), angle_rad, 1e-12);
        EXPECT_NEAR(scale_x(pose.a), 0.8, 1e-12);
        EXPECT_NEAR(scale_y(pose.a), 1.7, 1e-12);
    }
}

TEST(Pose, is_left_alone_by_the_transform_it_belongs_to) {
    const Pose affine{{1, 2}, (Eigen::Matrix2d() << 1, 0.3, -0.1, 0.9).finished()};
    EXPECT_EQ(constrained(affine, TransformKind::full_affine), affine);
    const Pose paper = pose_of(1, 2, 0.4, 0.9, 1.2);
    EXPECT_TRUE(constrained(paper, TransformKind::paper_affine).a.isApprox(paper.a, 1e-14));
    const Pose similar = pose_of(1, 2, -2.4, 1.3, 1.3);
    EXPECT_TRUE(constrained(similar, TransformKind::similarity).a.isApprox(similar.a, 1e-14));
}

TEST(Pose, keeps_only_the_angle_for_an_isometry) {
    const Pose rigid = constrained(pose_of(1, 2, 0.4, 0.9, 1.2), TransformKind::isometry);
    EXPECT_TRUE(rigid.a.isApprox(rotation(0.4), 1e-14));
}

TEST(Pose, is_refused_when_not_finite_mirrored_or_out_of_bounds) {
    const auto refused = [](const Pose& pose) {
        return !check(pose, TransformKind::full_affine).has_value();
    };
    EXPECT_FALSE(refused(Pose{}));
    EXPECT_TRUE(refused({{std::nan(""), 0}, Eigen::Matrix2d::Identity()}));
    EXPECT_TRUE(refused({{100'001, 0}, Eigen::Matrix2d::Identity()}));
    EXPECT_TRUE(refused({{0, 0}, Eigen::Vector2d(1, -1).asDiagonal()}));
    EXPECT_TRUE(refused({{0, 0}, Eigen::Matrix2d::Zero()}));
    EXPECT_TRUE(refused(pose_of(0, 0, 0, 0.009, 1)));
    EXPECT_TRUE(refused(pose_of(0, 0, 0, 101, 1)));
}

TEST(Pose, is_refused_where_the_transform_cannot_reach_it) {
    EXPECT_TRUE(check(pose_of(0, 0, 1, 1.01, 1.01), TransformKind::isometry));
    EXPECT_FALSE(check(pose_of(0, 0, 1, 1.3, 1.3), TransformKind::isometry));
    EXPECT_FALSE(check(pose_of(0, 0, 1, 1.3, 1.0), TransformKind::similarity));
    EXPECT_TRUE(check(pose_of(0, 0, 1, 1.3, 1.0), TransformKind::paper_affine));
}

}  // namespace
}  // namespace pursuit::tracker
