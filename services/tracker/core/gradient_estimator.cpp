// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/gradient_estimator.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace pursuit::tracker {

GradientEstimator::GradientEstimator(TransformKind transform, const Contour& contour,
                                     const ObjectParameters& parameters, Pull pull)
    : transform_(transform), pull_(pull), contour_(contour), parameters_(parameters) {
    set_parameters(parameters);
    restart({}, {});
}

void GradientEstimator::restart(const Pose& pose, const Velocity&) {
    pose_ = pose;
    measure_extent();
    lay_out();
    slope_.restart();
    turned_rad_ = 0;
    last_theta_rad_ = theta_rad(pose.a);
    residual_px_ = 0.5;
}

void GradientEstimator::set_parameters(const ObjectParameters& parameters) {
    parameters_ = parameters;
    gains_ = {parameters.gradient_position_gain, parameters.gradient_angle_gain_rad_px2,
              parameters.gradient_scale_gain_1_px, parameters.gradient_affine_gain_1_px2};
    is_laid_out_ = false;
    measure_extent();
}

void GradientEstimator::measure_extent() {
    extent_px_ = contour_.radius_px() * pose_.a.norm();
    reach2_px2_ = reach_px(0) * reach_px(0);
}

void GradientEstimator::lay_out() {
    if (pull_ == Pull::point) {
        contour_.fit_points(pose_.a, parameters_.gate_px);
    } else {
        contour_.fit(pose_.a, parameters_.gate_px);
    }
    is_laid_out_ = transform_ == TransformKind::isometry;
}

Approach GradientEstimator::approach(const Event& event, const PixelPast&) {
    q_ = Eigen::Vector2d(event.x, event.y) - pose_.t_px;
    if (q_.squaredNorm() > reach2_px2_) return {};
    if (!is_laid_out_) lay_out();
    const bool wants_points = pull_ == Pull::point;
    const double gate2 = parameters_.gate_px * parameters_.gate_px;
    CandidateGrid::Nearest on_contour;
    CandidateGrid::Nearest nearest;
    const auto look_up = [&](double x, double y, const auto& metric) {
        nearest = (wants_points ? contour_.points() : contour_.pieces()).nearest(x, y, metric);
        if (nearest.piece < 0 || !(nearest.squared_px <= gate2)) return;
        on_contour = wants_points ? contour_.pieces().nearest_among(
                                        contour_.pieces_at(nearest.piece), x, y, metric)
                                  : nearest;
    };
    const Eigen::Matrix2d& a = pose_.a;
    if (transform_ == TransformKind::isometry) {
        // The inverse of A is its transpose.
        look_up(a(0, 0) * q_.x() + a(1, 0) * q_.y(), a(0, 1) * q_.x() + a(1, 1) * q_.y(),
                ModelMetric());
    } else {
        const double per_area = 1 / (a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0));
        look_up((a(1, 1) * q_.x() - a(0, 1) * q_.y()) * per_area,
                (a(0, 0) * q_.y() - a(1, 0) * q_.x()) * per_area, ImageMetric(a));
    }
    if (nearest.piece < 0 || !(nearest.squared_px <= gate2)) return {};
    distance_px_ = std::sqrt(nearest.squared_px);
    m_ = (wants_points ? contour_.points() : contour_.pieces()).place(nearest);
    t_us_ = event.t_us;
    // Beside a little clutter.
    return {distance_px_, 0.02, std::sqrt(on_contour.squared_px), on_contour.piece};
}

double GradientEstimator::reach_px(std::int64_t) const { return extent_px_ + parameters_.gate_px; }

// As of events scattered by a pixel.
double GradientEstimator::likelihood() const {
    return 0.4 * std::exp(-0.5 * distance_px_ * distance_px_);
}

bool GradientEstimator::take(double weight) {
    if (!(weight > 0)) return false;
    descend(pose_, transform_, gains_, q_, m_, weight);
    if (transform_ != TransformKind::isometry) measure_extent();
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
