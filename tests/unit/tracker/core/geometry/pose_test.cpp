// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/geometry/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

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

TEST(Pose, is_sound_as_far_as_it_lies_within_2_percent_of_its_constrained_pose) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> angle(-3, 3);
    std::uniform_real_distribution<double> scale(0.9, 1.1);
    std::uniform_real_distribution<double> off(-0.03, 0.03);
    for (const TransformKind kind : {TransformKind::isometry, TransformKind::similarity,
                                     TransformKind::paper_affine, TransformKind::full_affine}) {
        int sound = 0;
        for (int i = 0; i < 1000; ++i) {
            const double s = scale(random);
            const bool is_unequal = kind == TransformKind::paper_affine;
            Pose pose = pose_of(100, 50, angle(random), s, is_unequal ? scale(random) : s);
            if (kind == TransformKind::isometry) pose.a /= s;
            pose.a += (Eigen::Matrix2d() << off(random), off(random), off(random), off(random))
                          .finished();
            const double strays = (constrained(pose, kind).a - pose.a).norm() / pose.a.norm();
            if (std::abs(strays - 0.02) < 1e-9) continue;
            EXPECT_EQ(is_sound(pose, kind), strays < 0.02);
            EXPECT_EQ(check(pose, kind).has_value(), strays < 0.02);
            sound += strays < 0.02 ? 1 : 0;
        }
        EXPECT_GT(sound, 100);
        if (kind != TransformKind::full_affine) {
            EXPECT_LT(sound, 1000);
        }
    }
}

// A stretched pose turns, and grows by a rate of its own along each of its axes.
TEST(RateOfArms, is_that_of_a_pose_that_turns_and_grows) {
    const Velocity velocity{0, 0, 0.7, 0.3, -0.5};
    const auto a_at = [&](double t_s) {
        return pose_of(0, 0, 0.4 + velocity.omega_rad_s * t_s,
                       1.5 * std::exp(velocity.scale_x_rate_per_s * t_s),
                       0.8 * std::exp(velocity.scale_y_rate_per_s * t_s))
            .a;
    };
    const Eigen::Matrix2d by_differences = (a_at(1e-4) - a_at(-1e-4)) / 2e-4;
    EXPECT_LT((rate_of_arms(a_at(0), velocity) * a_at(0) - by_differences).norm(), 1e-6);
}

TEST(RateOfArms, is_the_same_all_around_where_both_rates_are) {
    Eigen::Matrix2d rate;
    rate << 0.3, -0.7, 0.7, 0.3;
    EXPECT_EQ(rate_of_arms(pose_of(0, 0, 0.4, 2, 2).a, {5, 6, 0.7, 0.3, 0.3}), rate);
}

}  // namespace
}  // namespace pursuit::tracker
