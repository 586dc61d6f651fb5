// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/estimator/descent.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

// A model point at (10, 0) under the identity about (100, 50), and an event at (111, 52): q = (11,
// 2), m = (10, 0), q - m = (1, 2), m×q = 10·2 − 0·11 = 20.
const Eigen::Vector2d q_px(11, 2);
const Eigen::Vector2d m_px(10, 0);
const Pose start_pose = pose_of(100, 50, 0);

TEST(Descent, steps_translation_and_angle_by_equations_3_6_and_3_7) {
    Pose pose = start_pose;
    descend<TransformKind::isometry>(pose, {0.1, 2e-5, 1e-5, 0}, q_px, m_px, 1);
    EXPECT_NEAR(pose.t_px.x(), 100.2, 1e-12);
    EXPECT_NEAR(pose.t_px.y(), 50.4, 1e-12);
    EXPECT_NEAR(theta_rad(pose.a), 8e-4, 1e-12);
    EXPECT_NEAR(scale_x(pose.a), 1, 1e-12);
}

TEST(Descent, steps_the_scale_of_a_similarity_by_the_lengths) {
    Pose pose = start_pose;
    descend<TransformKind::similarity>(pose, {0, 0, 1e-3, 0}, q_px, m_px, 1);
    const double grown = 1 + 1e-3 * (std::sqrt(125.0) - 10);
    EXPECT_NEAR(scale_x(pose.a), grown, 1e-6);
    EXPECT_NEAR(scale_y(pose.a), grown, 1e-6);
}

TEST(Descent, steps_the_scales_of_the_paper_s_affine_in_the_body_s_axes) {
    // Turned by 90°, body x is image y: |q_b| − |m_b| = (2 − 0, 11 − 10) there.
    Pose pose = pose_of(100, 50, std::acos(-1.0) / 2, 1, 1);
    const Eigen::Vector2d turned_m = pose.a.transpose() * m_px;
    descend<TransformKind::paper_affine>(pose, {0, 0, 1e-3, 0}, q_px, turned_m, 1);
    EXPECT_NEAR(scale_x(pose.a), 1.002, 3e-6);
    EXPECT_NEAR(scale_y(pose.a), 1.001, 3e-6);
}

TEST(Descent, steps_the_whole_matrix_for_the_full_affine) {
    Pose pose = start_pose;
    descend<TransformKind::full_affine>(pose, {0, 0, 0, 1e-4}, q_px, m_px, 1);
    EXPECT_NEAR(pose.a(0, 0), 1 + 2e-4 * 1 * 10, 1e-15);
    EXPECT_NEAR(pose.a(1, 0), 2e-4 * 2 * 10, 1e-15);
    EXPECT_EQ(pose.a(0, 1), 0);
    EXPECT_EQ(pose.a(1, 1), 1);
}

TEST(Descent, takes_a_share_of_the_step_by_weight) {
    Pose pose = start_pose;
    descend<TransformKind::isometry>(pose, {0.1, 2e-5, 0, 0}, q_px, m_px, 0.25);
    EXPECT_NEAR(pose.t_px.y(), 50.1, 1e-12);
    EXPECT_NEAR(theta_rad(pose.a), 2e-4, 1e-12);
    descend<TransformKind::isometry>(pose, {0.1, 2e-5, 0, 0}, q_px, m_px, 0);
    EXPECT_NEAR(pose.t_px.y(), 50.1, 1e-12);
}

TEST(Descent, leaves_the_pose_where_the_event_lies_on_the_point) {
    const auto left = []<TransformKind kind> {
        Pose pose = start_pose;
        descend<kind>(pose, {0.1, 1e-3, 1e-3, 1e-3}, m_px, m_px, 1);
        return pose;
    };
    EXPECT_EQ(left.operator()<TransformKind::isometry>(), start_pose);
    EXPECT_EQ(left.operator()<TransformKind::similarity>(), start_pose);
    EXPECT_EQ(left.operator()<TransformKind::paper_affine>(), start_pose);
    EXPECT_EQ(left.operator()<TransformKind::full_affine>(), start_pose);
}

TEST(Descent, stays_an_isometry_over_ten_million_steps) {
    Pose pose = start_pose;
    for (int i = 0; i < 10'000'000; ++i) {
        const double side = i % 3 == 0 ? 2 : -1;
        descend<TransformKind::isometry>(pose, {0, 1e-4, 0, 0},
                                         pose.a * m_px + Eigen::Vector2d(0, side), m_px, 1);
    }
    EXPECT_NEAR((pose.a.transpose() * pose.a - Eigen::Matrix2d::Identity()).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace pursuit::tracker
