// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "services/common/result.hpp"
#include "services/tracker/core/kinds.hpp"

namespace pursuit::tracker {

/// image_from_model: p = t_px + a·m. Image frame: x right, y down, pixel centres at integers.
/// Model frame: px about the model's centre of gravity. T and A are the pose; angle and scales are
/// derived from them for reading.
struct Pose {
    Eigen::Vector2d t_px = Eigen::Vector2d::Zero();
    Eigen::Matrix2d a = Eigen::Matrix2d::Identity();

    friend bool operator==(const Pose& l, const Pose& r) { return l.t_px == r.t_px && l.a == r.a; }
};

/// How the pose changes with time.
struct Velocity {
    double vx_px_s = 0;  ///< Of T, in image axes.
    double vy_px_s = 0;
    double omega_rad_s = 0;
    double scale_x_rate_per_s = 0;  ///< d(log scale_x)/dt.
    double scale_y_rate_per_s = 0;

    friend bool operator==(const Velocity&, const Velocity&) = default;
};

/// R(θ)
Eigen::Matrix2d rotation(double theta_rad);

/// A pose from the readable numbers: A = R(θ)·diag(sx, sy).
Pose pose_of(double x_px, double y_px, double theta_rad, double scale_x = 1, double scale_y = 1);

/// Rotation of the polar decomposition of A, -π … π.
double theta_rad(const Eigen::Matrix2d& a);

/// Lengths that A gives to the model's own unit axes: the columns' norms.
double scale_x(const Eigen::Matrix2d& a);
double scale_y(const Eigen::Matrix2d& a);
/// How fast the arms d = A·m of a pose go about T with this velocity: d(d)/dt = rate·d. They turn,
/// and grow by one rate along the image of the model's x axis and by the other across it.
Eigen::Matrix2d rate_of_arms(const Eigen::Matrix2d& a, const Velocity& velocity);

/// By how much A makes anything longer at most: its larger singular value.
double largest_scale(const Eigen::Matrix2d& a);

/// The bounds of a pose that the tracker takes: |T| ≤ 100,000 px and both singular values of A
/// within 0.01 … 100, A without a reflection.
constexpr double max_position_px = 100'000;
constexpr double min_scale = 0.01;
constexpr double max_scale = 100;

/// Refuses a pose out of bounds, and one that lies more than 2 % from the nearest pose of `kind`.
Result<void> check(const Pose& pose, TransformKind kind);
/// Whether it does not: for what asks all the time, and of nobody else's pose.
bool is_sound(const Pose& pose, TransformKind kind);

/// Refuses speeds that are not finite, beyond ±1e7 px/s or ±1e5 rad/s.
Result<void> check(const Velocity& velocity);

/// The nearest pose that `kind` allows: an isometry keeps the angle of A alone, and so on.
Pose constrained(const Pose& pose, TransformKind kind);

}  // namespace pursuit::tracker
