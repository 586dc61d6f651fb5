// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/geometry/pose.hpp"

#include <Eigen/LU>
#include <cmath>
#include <string>

namespace pursuit::tracker {

Eigen::Matrix2d rotation(double theta_rad) {
    const double c = std::cos(theta_rad);
    const double s = std::sin(theta_rad);
    Eigen::Matrix2d r;
    r << c, -s, s, c;
    return r;
}

Pose pose_of(double x_px, double y_px, double theta_rad, double scale_x, double scale_y) {
    Pose pose;
    pose.t_px << x_px, y_px;
    pose.a = rotation(theta_rad) * Eigen::Vector2d(scale_x, scale_y).asDiagonal();
    return pose;
}

double theta_rad(const Eigen::Matrix2d& a) {
    return std::atan2(a(1, 0) - a(0, 1), a(0, 0) + a(1, 1));
}

double scale_x(const Eigen::Matrix2d& a) { return std::hypot(a(0, 0), a(1, 0)); }
double scale_y(const Eigen::Matrix2d& a) { return std::hypot(a(0, 1), a(1, 1)); }

Eigen::Matrix2d rate_of_arms(const Eigen::Matrix2d& a, const Velocity& velocity) {
    const double growth = (velocity.scale_x_rate_per_s + velocity.scale_y_rate_per_s) / 2;
    Eigen::Matrix2d rate;
    rate << growth, -velocity.omega_rad_s, velocity.omega_rad_s, growth;
    const double more_along = velocity.scale_x_rate_per_s - growth;
    if (more_along == 0) return rate;
    // What grows more along the axis grows that much less across it: more·(2·uuᵀ − 1).
    const Eigen::Vector2d axis = a.col(0).normalized();
    rate += more_along * (2 * axis * axis.transpose() - Eigen::Matrix2d::Identity());
    return rate;
}

double largest_scale(const Eigen::Matrix2d& a) {
    // Singular values of a 2×2 matrix from its norm and determinant.
    const double twice = 2 * std::abs(a.determinant());
    const double norm2 = a.squaredNorm();
    return (std::sqrt(norm2 + twice) + std::sqrt(std::max(0.0, norm2 - twice))) / 2;
}

namespace {

// How far A is from what the transform makes of it, ‖A − constrained(A)‖². (Without an angle: this
// is asked of every object all the time.) A may not mirror.
double strays2(const Eigen::Matrix2d& a, TransformKind kind) {
    const double norm2 = a.squaredNorm();
    // The nearest rotation has the columns (x, y)/length and (−y, x)/length.
    const double x = a(0, 0) + a(1, 1);
    const double y = a(1, 0) - a(0, 1);
    const double length = std::sqrt(x * x + y * y);
    switch (kind) {
        case TransformKind::isometry:
            return norm2 - 2 * length + 2;
        case TransformKind::similarity:
            return norm2 - length * length / 2;
        case TransformKind::paper_affine: {
            const double along_x = (x * a(0, 0) + y * a(1, 0)) / length;
            const double along_y = (x * a(1, 1) - y * a(0, 1)) / length;
            return norm2 - along_x * along_x - along_y * along_y;
        }
        case TransformKind::full_affine:
            break;
    }
    return 0;
}

// Of what A is not that of its transform.
constexpr double most_strays = 0.02;

}  // namespace

bool is_sound(const Pose& pose, TransformKind kind) {
    const double determinant = pose.a.determinant();
    const double largest = largest_scale(pose.a);
    // (What is not a finite number is within no bounds.)
    return std::abs(pose.t_px.x()) <= max_position_px &&
           std::abs(pose.t_px.y()) <= max_position_px && determinant > 0 &&
           determinant / largest >= min_scale && largest <= max_scale &&
           strays2(pose.a, kind) <= most_strays * most_strays * pose.a.squaredNorm();
}

Result<void> check(const Pose& pose, TransformKind kind) {
    if (is_sound(pose, kind)) return {};
    if (!pose.t_px.allFinite() || !pose.a.allFinite()) {
        return fail("pose: a component is not a finite number");
    }
    if (pose.t_px.cwiseAbs().maxCoeff() > max_position_px) {
        return fail("pose: x_px or y_px is not within -100000 to 100000");
    }
    const double determinant = pose.a.determinant();
    if (!(determinant > 0)) return fail("pose: A mirrors or flattens the shape");
    const double largest = largest_scale(pose.a);
    const double smallest = determinant / largest;
    if (!(smallest >= min_scale) || !(largest <= max_scale)) {
        return fail("pose: A scales by a factor that is not within 0.01 to 100");
    }
    return fail("pose: A is not that of the transform " + std::string(to_string(kind)));
}

Result<void> check(const Velocity& velocity) {
    const auto within = [](double value, double bound) { return std::abs(value) <= bound; };
    if (!within(velocity.vx_px_s, 1e7) || !within(velocity.vy_px_s, 1e7)) {
        return fail("velocity: vx_px_s or vy_px_s is not a number within -1e7 to 1e7");
    }
    if (!within(velocity.omega_rad_s, 1e5)) {
        return fail("velocity: omega_rad_s is not a number within -1e5 to 1e5");
    }
    if (!within(velocity.scale_x_rate_per_s, 1e4) || !within(velocity.scale_y_rate_per_s, 1e4)) {
        return fail("velocity: a scale rate is not a number within -1e4 to 1e4");
    }
    return {};
}

Pose constrained(const Pose& pose, TransformKind kind) {
    if (kind == TransformKind::full_affine) return pose;
    const Eigen::Matrix2d r = rotation(theta_rad(pose.a));
    const Eigen::Vector2d scales(r.col(0).dot(pose.a.col(0)), r.col(1).dot(pose.a.col(1)));
    switch (kind) {
        case TransformKind::isometry:
            return {pose.t_px, r};
        case TransformKind::similarity:
            return {pose.t_px, r * scales.mean()};
        case TransformKind::paper_affine:
            return {pose.t_px, r * scales.asDiagonal()};
        case TransformKind::full_affine:
            break;
    }
    return pose;
}

}  // namespace pursuit::tracker
