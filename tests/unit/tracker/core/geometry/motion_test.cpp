// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/geometry/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "services/tracker/core/estimator/twist_filter.hpp"

namespace pursuit::tracker {
namespace {

template <TransformKind k>
struct Of {
    static constexpr TransformKind kind = k;
};

Pose a_pose(TransformKind kind) {
    const Pose affine{{100, 60}, (Eigen::Matrix2d() << 0.9, -0.4, 0.3, 1.2).finished()};
    return constrained(affine, kind);
}

template <class T>
class MotionOf : public testing::Test {};
using Kinds = testing::Types<Of<TransformKind::isometry>, Of<TransformKind::similarity>,
                             Of<TransformKind::paper_affine>, Of<TransformKind::full_affine>>;
TYPED_TEST_SUITE(MotionOf, Kinds);

TYPED_TEST(MotionOf, has_the_derivative_that_differences_show) {
    using M = Motion<TypeParam::kind>;
    const Pose pose = a_pose(TypeParam::kind);
    const Eigen::Vector2d n = Eigen::Vector2d(0.6, -0.8);
    const Eigen::Vector2d m(13, -7);
    const auto j = M::along(n, pose.a * m, pose.a, m);
    for (int i = 0; i < M::dof; ++i) {
        typename M::Step step = M::Step::Zero();
        step(i) = 1e-6;
        Pose ahead = pose;
        M::apply(step, ahead);
        Pose behind = pose;
        M::apply(-step, behind);
        const double difference =
            n.dot(ahead.t_px + ahead.a * m - behind.t_px - behind.a * m) / 2e-6;
        EXPECT_NEAR(j(i), difference, 1e-6) << "component " << i;
    }
}

TYPED_TEST(MotionOf, stays_a_pose_of_its_kind_over_many_steps) {
    using M = Motion<TypeParam::kind>;
    Pose pose = a_pose(TypeParam::kind);
    typename M::Step step = M::Step::Constant(1e-5);
    if constexpr (TypeParam::kind == TransformKind::full_affine) step << 0, 0, 0, -1e-5, 1e-5, 0;
    for (int i = 0; i < 100'000; ++i) M::apply(step, pose);
    EXPECT_LT((constrained(pose, TypeParam::kind).a - pose.a).norm(), 1e-9 * pose.a.norm());
}

TYPED_TEST(MotionOf, predicts_what_a_step_makes_and_is_tidied_with_the_next_one) {
    using M = Motion<TypeParam::kind>;
    typename M::Step step = M::Step::Constant(2e-3);
    Pose pose = a_pose(TypeParam::kind);
    Pose predicted = pose;
    for (int i = 0; i < 1000; ++i) {
        M::apply(step, pose);
        M::template apply<false>(step, predicted);
        step = -step;
    }
    EXPECT_LT((pose.a - predicted.a).norm(), 1e-9);
    for (int i = 0; i < 3; ++i) M::apply(M::Step::Zero(), predicted);
    EXPECT_LT((predicted.a - constrained(predicted, TypeParam::kind).a).norm(), 1e-12);
}

TYPED_TEST(MotionOf, reads_velocities_back_as_they_were_given) {
    using M = Motion<TypeParam::kind>;
    Velocity given{30, -20, 2, 0, 0};
    if constexpr (TypeParam::kind != TransformKind::isometry) {
        given.scale_x_rate_per_s = given.scale_y_rate_per_s = 0.3;
    }
    const Pose pose = a_pose(TypeParam::kind);
    const Velocity read = M::velocity(M::twist_of(given), pose.a);
    EXPECT_NEAR(read.vx_px_s, given.vx_px_s, 1e-12);
    EXPECT_NEAR(read.vy_px_s, given.vy_px_s, 1e-12);
    EXPECT_NEAR(read.omega_rad_s, given.omega_rad_s, 1e-12);
    EXPECT_NEAR(read.scale_x_rate_per_s, given.scale_x_rate_per_s, 1e-12);
    EXPECT_NEAR(read.scale_y_rate_per_s, given.scale_y_rate_per_s, 1e-12);
}

// The filter's sparse algebra against the textbook's, written out with full matrices.
TYPED_TEST(MotionOf, is_filtered_as_full_matrices_would) {
    using Filter = TwistFilter<TypeParam::kind>;
    using Step = typename Filter::Step;
    constexpr int dof = Filter::dof;
    constexpr int size = Filter::size;
    const Pose pose = a_pose(TypeParam::kind);
    Filter filter;
    filter.restart(pose, Step::Zero(), Step::Constant(0.5), Step::Constant(30));
    filter.restart_leads(typename Filter::Leads(0.1, -0.4, 0.5, 0),
                         0.09 * Filter::LeadCovariance::Identity());

    using Full = Eigen::MatrixXd;  // unrolled, the same would take a minute to compile
    Full p = filter.covariance();
    const Eigen::Vector2d m(11, 5);
    Step noise = Step::Constant(40);
    for (int round = 0; round < 50; ++round) {
        const double dt_s = 1e-3 * (1 + round % 3);
        Full f = Full::Identity(size, size);
        f.block(0, dof, dof, dof).diagonal().setConstant(dt_s);
        Full drift = Full::Zero(size, size);
        drift.block(0, 0, dof, dof).diagonal() = noise * (dt_s * dt_s * dt_s / 3);
        drift.block(0, dof, dof, dof).diagonal() = noise * (dt_s * dt_s / 2);
        drift.block(dof, 0, dof, dof).diagonal() = noise * (dt_s * dt_s / 2);
        drift.block(dof, dof, dof, dof).diagonal() = noise * dt_s;
        p = Full(f * p * f.transpose() + drift);
        filter.advance(dt_s);
        filter.spread(dt_s, noise);

        const Eigen::Vector2d n(std::cos(round), std::sin(round));
        const Step j = Motion<TypeParam::kind>::along(n, pose.a * m, pose.a, m);
        const int lead = round % 4;
        Eigen::VectorXd h = Eigen::VectorXd::Zero(size);
        h.head(dof) = j;
        h(2 * dof + lead) = 0.7;
        const double variance = h.dot(p * h) + 0.16;
        const auto row = filter.row(j, lead, 0.7);
        EXPECT_NEAR(row.h_p_h + 0.16, variance, 1e-9 * variance);
        p -= Full((p * h) * (p * h).transpose() / variance);
        filter.correct(row, 0, 1 / variance);
    }
    EXPECT_LT((filter.covariance() - p).norm(), 1e-9 * p.norm());
    EXPECT_LT((filter.covariance() - filter.covariance().transpose()).norm(), 1e-9 * p.norm());
}

TEST(Motion, turns_by_the_angle_to_the_third_order_and_by_a_large_one_to_the_fourth) {
    for (const double angle : {0.0, 1e-6, -3e-3, 9.9e-3, 0.0101, -0.1}) {
        Eigen::Matrix2d a = rotation(0.7);
        Motion<TransformKind::isometry>::turn(angle, a);
        const double order = std::abs(angle) < 0.01 ? std::pow(angle, 4) : std::pow(angle, 5);
        EXPECT_LT((a - rotation(0.7 + angle)).norm(), 1e-15 + std::abs(order)) << angle;
    }
}

TEST(Motion, carries_a_turning_object_on_its_circle) {
    using M = Motion<TransformKind::isometry>;
    // About the origin at 50 px, 20 rad/s: T moves at 1000 px/s square to its arm.
    Pose pose = pose_of(50, 0, 0);
    M::Step twist;
    twist << 0, 1000, 20;
    for (int i = 0; i < 10'000; ++i) TwistFilter<TransformKind::isometry>::move(1e-5, pose, twist);
    EXPECT_NEAR(pose.t_px.x(), 50 * std::cos(2.0), 1e-2);
    EXPECT_NEAR(pose.t_px.y(), 50 * std::sin(2.0), 1e-2);
    EXPECT_NEAR(theta_rad(pose.a), 2.0, 1e-9);
    EXPECT_NEAR(twist.head<2>().norm(), 1000, 1e-2);
}

}  // namespace
}  // namespace pursuit::tracker
