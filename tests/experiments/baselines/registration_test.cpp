// SPDX-License-Identifier: Apache-2.0
#include "tests/experiments/baselines/registration.hpp"

#include <gtest/gtest.h>

namespace pursuit::experiments {
namespace {

using tracker::Pose;
using tracker::pose_of;
using tracker::TransformKind;

/// The outline of a rectangle of 40 x 20 with a notch, a point every 2 px.
Points outline() {
    Points points;
    for (int x = -20; x < 20; x += 2) points.emplace_back(x, -10);
    for (int y = -10; y < 10; y += 2) points.emplace_back(20, y);
    for (int x = 20; x > -20; x -= 2) points.emplace_back(x, x > 0 && x < 9 ? 6 : 10);
    for (int y = 10; y > -10; y -= 2) points.emplace_back(-20, y);
    return points;
}

Points placed(const Points& model, const Pose& pose) {
    Points points;
    for (const auto& m : model) points.push_back(pose.t_px + pose.a * m);
    return points;
}

void expect_near(const Pose& pose, const Pose& expected, double tolerance) {
    EXPECT_LT((pose.t_px - expected.t_px).norm(), tolerance);
    EXPECT_LT((pose.a - expected.a).norm(), tolerance);
}

TEST(Fitted, finds_each_transform_from_exact_pairs) {
    const Points model = outline();
    const Pose isometry = pose_of(100, 80, 0.4);
    const Pose similarity = pose_of(100, 80, 0.4, 1.3, 1.3);
    const Pose paper_affine = pose_of(100, 80, 0.4, 1.3, 0.8);
    Pose full_affine = paper_affine;
    full_affine.a(0, 1) += 0.3;
    const Pose unused;
    expect_near(fitted(model, placed(model, isometry), TransformKind::isometry, unused), isometry,
                1e-9);
    expect_near(fitted(model, placed(model, similarity), TransformKind::similarity, unused),
                similarity, 1e-9);
    expect_near(fitted(model, placed(model, paper_affine), TransformKind::paper_affine, unused),
                paper_affine, 1e-9);
    expect_near(fitted(model, placed(model, full_affine), TransformKind::full_affine, unused),
                full_affine, 1e-9);
}

TEST(Fitted, leaves_the_pose_where_an_affine_map_is_not_told) {
    const Points line{{0, 0}, {1, 0}, {2, 0}, {3, 0}};
    const Pose before = pose_of(5, 6, 0.1);
    expect_near(fitted(line, line, TransformKind::full_affine, before), before, 1e-12);
}

TEST(Registered, finds_the_shape_from_where_each_point_is_nearest_to_its_own) {
    const Points model = outline();
    const Pose truth = pose_of(100, 80, 0.2);
    RegistrationSettings settings;
    expect_near(registered(model, placed(model, truth), pose_of(100.4, 79.6, 0.21), settings),
                truth, 1e-9);
}

TEST(Registered, comes_nearer_with_each_iteration_from_farther_away) {
    const Points model = outline();
    const Pose truth = pose_of(100, 80, 0.2);
    const Pose start = pose_of(103, 78, 0.12);
    RegistrationSettings settings;
    double before_px = (start.t_px - truth.t_px).norm();
    for (const int iterations : {1, 2, 4}) {
        settings.iterations = iterations;
        const auto pose = registered(model, placed(model, truth), start, settings);
        const double off_px = (pose.t_px - truth.t_px).norm();
        EXPECT_LT(off_px, before_px) << iterations;
        before_px = off_px;
    }
}

TEST(Registered, leaves_out_what_is_beyond_the_gate) {
    const Points model = outline();
    const Pose truth = pose_of(100, 80, 0);
    Points frame = placed(model, truth);
    for (int i = 0; i < 40; ++i) frame.emplace_back(150 + i % 7, 120 + i % 5);
    RegistrationSettings settings;
    settings.iterations = 20;
    EXPECT_GT((registered(model, frame, truth, settings).t_px - truth.t_px).norm(), 5);
    settings.gate_px = 4;
    expect_near(registered(model, frame, truth, settings), truth, 1e-6);
}

TEST(Registered, stays_where_there_are_too_few_points_and_goes_a_share_of_the_way) {
    const Points model = outline();
    const Pose before = pose_of(100, 80, 0);
    RegistrationSettings settings;
    settings.least_points = 4;
    expect_near(registered(model, {{99, 70}, {98, 70}, {120, 80}}, before, settings), before,
                1e-12);
    settings.share = 0.25;
    const auto after = registered(model, placed(model, pose_of(100.8, 80, 0)), before, settings);
    EXPECT_NEAR(after.t_px.x(), 100.2, 0.1);
}

}  // namespace
}  // namespace pursuit::experiments
