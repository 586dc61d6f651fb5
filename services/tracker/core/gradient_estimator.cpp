// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/gradient_estimator.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace pursuit::tracker {

GradientEstimator::GradientEstimator(TransformKind transform, const Contour& contour,
                                     const ObjectParameters& parameters, Pull pull)
    : transform_(transform), pull_(pull), contour_(contour), parameters_(parameters) {
    restart({}, {});
}

void GradientEstimator::restart(const Pose& pose, const Velocity&) {
    pose_ = pose;
    slope_.restart();
    turned_rad_ = 0;
    last_theta_rad_ = theta_rad(pose.a);
    residual_px_ = 0.5;
}

void GradientEstimator::set_parameters(const ObjectParameters& parameters) {
    parameters_ = parameters;
}

Approach GradientEstimator::approach(const Event& event, std::int64_t) {
    q_ = Eigen::Vector2d(event.x, event.y) - pose_.t_px;
    const double within_px = reach_px(event.t_us);
    if (q_.squaredNorm() > within_px * within_px) return {};
    contour_.fit(pose_.a, parameters_.gate_px);
    if (pull_ == Pull::point) contour_.fit_points(pose_.a, parameters_.gate_px);
    const Eigen::Vector2d x = pose_.a.inverse() * q_;
    const ImageMetric metric(pose_.a);
    const CandidateGrid& grid = pull_ == Pull::point ? contour_.points() : contour_.pieces();
    const auto nearest = grid.nearest(x.x(), x.y(), metric);
    if (nearest.piece < 0) return {};
    distance_px_ = std::sqrt(nearest.squared_px);
    if (distance_px_ > parameters_.gate_px) return {};
    const Piece& piece = grid.pieces()[static_cast<std::size_t>(nearest.piece)];
    m_ << piece.ax + nearest.foot * (piece.bx - piece.ax),
        piece.ay + nearest.foot * (piece.by - piece.ay);
    t_us_ = event.t_us;
    const auto on_contour =
        pull_ == Pull::contour ? nearest : contour_.pieces().nearest(x.x(), x.y(), metric);
    // As of events scattered by a pixel, beside a little clutter.
    return {distance_px_, 0.4 * std::exp(-0.5 * distance_px_ * distance_px_), 0.02,
            std::sqrt(on_contour.squared_px), on_contour.piece};
}

double GradientEstimator::reach_px(std::int64_t) const {
    return contour_.radius_px() * pose_.a.norm() + parameters_.gate_px;
}

bool GradientEstimator::take(double weight) {
    if (!(weight > 0)) return false;
    const DescentGains gains{
        parameters_.gradient_position_gain, parameters_.gradient_angle_gain_rad_px2,
        parameters_.gradient_scale_gain_1_px, parameters_.gradient_affine_gain_1_px2};
    descend(pose_, transform_, gains, q_, m_, weight);
    residual_px_ += 0.01 * weight * (distance_px_ - residual_px_);
    if (slope_.is_due(t_us_)) {
        const double theta = theta_rad(pose_.a);
        turned_rad_ += std::remainder(theta - last_theta_rad_, 2 * std::numbers::pi);
        last_theta_rad_ = theta;
        Slope<5>::Values values;
        values << pose_.t_px.x(), pose_.t_px.y(), turned_rad_, std::log(scale_x(pose_.a)),
            std::log(scale_y(pose_.a));
        slope_.add(t_us_, values);
    }
    return true;
}

Velocity GradientEstimator::velocity() const {
    const auto slope = slope_.per_s();
    return {slope(0), slope(1), slope(2), slope(3), slope(4)};
}

void GradientEstimator::describe(std::int64_t, PoseRecord& record) const {
    record.pose = pose_;
    record.velocity = velocity();
    record.pose_covariance.fill(std::nan(""));
    record.velocity_covariance.fill(std::nan(""));
    record.mean_residual_px = static_cast<float>(residual_px_);
}

}  // namespace pursuit::tracker
