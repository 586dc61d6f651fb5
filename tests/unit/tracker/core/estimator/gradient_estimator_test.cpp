// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/estimator/gradient_estimator.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/geometry/reach_map.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

constexpr double gate_px = 4;

std::unique_ptr<Estimator> descent(TransformKind transform, double position_gain,
                                   double scale_gain_1_px, double affine_gain_1_px2) {
    ObjectParameters parameters;
    parameters.gate_px = gate_px;
    parameters.gradient_position_gain = position_gain;
    parameters.gradient_scale_gain_1_px = scale_gain_1_px;
    parameters.gradient_affine_gain_1_px2 = affine_gain_1_px2;
    auto estimator = make_estimator(EstimatorKind::gradient, transform, test::arrow(), parameters);
    estimator->restart(pose_of(150, 120, 0), {});
    return estimator;
}

/// How much farther it reaches after as many events as come before it is placed anew, each as far
/// beyond its farthest point as an event can be.
double more_reach_px(Estimator& estimator) {
    Eigen::Vector2d corner_px = Eigen::Vector2d::Zero();
    for (const auto& point : test::arrow().points_px) {
        if (point.norm() > corner_px.norm()) corner_px = point.cast<double>();
    }
    const Pose before = estimator.pose();
    const double reach_px = estimator.reach_px(0);
    for (int i = 1; i < ReachMap::placed_every_events; ++i) {
        const Eigen::Vector2d arm_px = estimator.pose().a * corner_px;
        const Eigen::Vector2d at_px =
            estimator.pose().t_px + arm_px + (gate_px - 1) * arm_px.normalized();
        const Event event{i, static_cast<std::uint16_t>(std::lround(at_px.x())),
                          static_cast<std::uint16_t>(std::lround(at_px.y())), 1};
        EXPECT_NE(estimator.approach(event, {}), nullptr);
        EXPECT_TRUE(estimator.take(1));
    }
    return (estimator.pose().t_px - before.t_px).norm() + estimator.reach_px(0) - reach_px;
}

TEST(GradientEstimator, leaps_where_few_events_let_it_reach_farther_than_the_map_has_room_for) {
    int leaping = 0;
    for (const TransformKind transform :
         {TransformKind::isometry, TransformKind::similarity, TransformKind::paper_affine,
          TransformKind::full_affine}) {
        for (const double position_gain : {0.0, 0.01, 0.03, 0.1}) {
            for (const double more : {0.0, 1e-4, 1e-3, 1e-2}) {
                const auto estimator = descent(transform, position_gain, more, more / 10);
                const bool leaps = estimator->leaps();
                if (more_reach_px(*estimator) <= ReachMap::reserve_px) continue;
                EXPECT_TRUE(leaps) << to_string(transform) << ' ' << position_gain << ' ' << more;
                ++leaping;
            }
        }
    }
    EXPECT_GT(leaping, 16);
}

TEST(GradientEstimator, does_not_leap_with_the_usual_gains_of_what_keeps_its_form) {
    const ObjectParameters usual;
    for (const TransformKind transform : {TransformKind::isometry, TransformKind::similarity}) {
        const auto estimator =
            descent(transform, usual.gradient_position_gain, usual.gradient_scale_gain_1_px,
                    usual.gradient_affine_gain_1_px2);
        EXPECT_FALSE(estimator->leaps());
    }
}

}  // namespace
}  // namespace pursuit::tracker
