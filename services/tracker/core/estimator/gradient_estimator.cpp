// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/estimator/gradient_estimator.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "services/tracker/core/geometry/reach_map.hpp"

namespace pursuit::tracker {
namespace {

// Beside a little clutter.
constexpr double usual_clutter = 0.02;

}  // namespace

template <TransformKind kind>
GradientEstimator<kind>::GradientEstimator(const Contour& contour,
                                           const ObjectParameters& parameters, Pull pull)
    : pull_(pull), contour_(contour), parameters_(parameters) {
    near_.clutter = usual_clutter;
    set_parameters(parameters);
    restart({}, {});
}

template <TransformKind kind>
void GradientEstimator<kind>::restart(const Pose& pose, const Velocity&) {
    pose_ = pose;
    measure_extent();
    contour_.forget_excess(pose.a, parameters_.gate_px);
    lay_out();
    slope_.restart();
    turned_rad_ = 0;
    last_theta_rad_ = theta_rad(pose.a);
    residual_px_ = 0.5;
}

template <TransformKind kind>
void GradientEstimator<kind>::set_parameters(const ObjectParameters& parameters) {
    parameters_ = parameters;
    gains_ = {parameters.gradient_position_gain, parameters.gradient_angle_gain_rad_px2,
              parameters.gradient_scale_gain_1_px, parameters.gradient_affine_gain_1_px2};
    const double gate_px = parameters.gate_px;
    gate2_px2_ = gate_px * gate_px;
    plainly2_px2_ = gate2_px2_ / 16;
    measure_extent();
    lay_out();
}

template <TransformKind kind>
void GradientEstimator<kind>::measure_extent() {
    extent_px_ = contour_.radius_px() * largest_scale(pose_.a);
    reach2_px2_ = reach_px(0) * reach_px(0);
}

template <TransformKind kind>
void GradientEstimator<kind>::lay_out() {
    if (pull_ == Pull::point) {
        contour_.fit_points(pose_.a, parameters_.gate_px);
    } else {
        contour_.fit(pose_.a, parameters_.gate_px);
    }
}

template <TransformKind kind>
const Approach* GradientEstimator<kind>::approach(const Event& event, const PixelPast&) {
    const double qx = event.x - pose_.t_px.x();
    const double qy = event.y - pose_.t_px.y();
    t_us_ = event.t_us;
    const Eigen::Matrix2d& a = pose_.a;
    if constexpr (keeps_its_size) {
        // The inverse of A is its transpose. (What is farther than the gate from all of the shape
        // is in no cell of the grid.)
        return approach_at(a(0, 0) * qx + a(1, 0) * qy, a(0, 0) * qy - a(1, 0) * qx, ModelMetric());
    } else {
        q_ << qx, qy;
        if (q_.squaredNorm() > reach2_px2_) return nullptr;
        lay_out();
        const double per_area = 1 / (a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0));
        return approach_at((a(1, 1) * q_.x() - a(0, 1) * q_.y()) * per_area,
                           (a(0, 0) * q_.y() - a(1, 0) * q_.x()) * per_area, ImageMetric(a));
    }
}

template <TransformKind kind>
template <class Metric>
[[gnu::always_inline]] inline const Approach* GradientEstimator<kind>::approach_at(
    double x, double y, const Metric& metric) {
    const bool wants_point = pull_ == Pull::point;
    const CandidateGrid& grid = wants_point ? contour_.points() : contour_.pieces();
    const auto nearest = grid.nearest(x, y, metric);
    if (nearest.piece < 0 || !(nearest.squared_px <= gate2_px2_)) return nullptr;
    m_ = grid.place(nearest);
    if constexpr (keeps_its_size) off_ << x - m_.x(), y - m_.y();
    near_.distance2_px2 = near_.contour2_px2 = nearest.squared_px;
    near_.piece = nearest.piece;
    if (wants_point) look_at_contour(x, y, metric, nearest);
    return &near_;
}

template <TransformKind kind>
template <class Metric>
[[gnu::always_inline]] inline void GradientEstimator<kind>::look_at_contour(
    double x, double y, const Metric& metric, const CandidateGrid::Nearest& point) {
    const auto ending = contour_.pieces_at(point.piece);
    near_.piece = ending.front();
    if (point.squared_px < plainly2_px2_) return;
    const auto nearest = contour_.pieces().nearest_among(ending, x, y, metric);
    near_.contour2_px2 = nearest.squared_px;
    near_.piece = nearest.piece;
}

template <TransformKind kind>
double GradientEstimator<kind>::reach_px(std::int64_t) const {
    return extent_px_ + parameters_.gate_px;
}

// An event moves it by twice the gain of how far off it is, and may make it larger as well. (It
// turns about its own place, and reaches no farther by that.) The last event before it is placed
// anew is asked about after one step less.
template <TransformKind kind>
bool GradientEstimator<kind>::leaps() const {
    const double off_px = parameters_.gate_px;
    double step_px = 2 * gains_.position * off_px;
    if constexpr (kind == TransformKind::full_affine) {
        const double arm_px = contour_.radius_px();
        step_px += 2 * gains_.affine_1_px2 * off_px * arm_px * arm_px;
    } else if constexpr (!keeps_its_size) {
        const double log_scale = gains_.scale_1_px * off_px;
        step_px += extent_px_ * log_scale * (1 + log_scale / 2);
    }
    return (ReachMap::placed_every_events - 1) * step_px > ReachMap::reserve_px;
}

// As of events scattered by a pixel.
template <TransformKind kind>
double GradientEstimator<kind>::likelihood() const {
    return 0.4 * std::exp(-0.5 * near_.distance2_px2);
}

template <TransformKind kind>
bool GradientEstimator<kind>::take(double weight) {
    if (!(weight > 0)) return false;
    if constexpr (keeps_its_size) {
        descend_rigidly(pose_, gains_, off_, m_, weight);
    } else {
        descend<kind>(pose_, gains_, q_, m_, weight);
        measure_extent();
    }
    residual_px_ += 0.01 * weight * (near_.distance_px() - residual_px_);
    if (slope_.is_due(t_us_)) sample_slope();
    return true;
}

template <TransformKind kind>
void GradientEstimator<kind>::sample_slope() {
    const double theta = theta_rad(pose_.a);
    double more_rad = theta - last_theta_rad_;
    // (Within half a turn it is its own remainder.)
    if (!(std::abs(more_rad) <= std::numbers::pi)) {
        more_rad = std::remainder(more_rad, 2 * std::numbers::pi);
    }
    turned_rad_ += more_rad;
    last_theta_rad_ = theta;
    typename PoseSlope::Values values;
    values.template head<3>() << pose_.t_px.x(), pose_.t_px.y(), turned_rad_;
    if constexpr (!keeps_its_size) {
        values(3) = std::log(scale_x(pose_.a));
        values(4) = std::log(scale_y(pose_.a));
    }
    slope_.add(t_us_, values);
}

template <TransformKind kind>
Velocity GradientEstimator<kind>::velocity() const {
    const auto slope = slope_.per_s();
    if constexpr (keeps_its_size) {
        return {slope(0), slope(1), slope(2), 0, 0};
    } else {
        return {slope(0), slope(1), slope(2), slope(3), slope(4)};
    }
}

template <TransformKind kind>
void GradientEstimator<kind>::describe(std::int64_t, PoseRecord& record) const {
    record.pose = pose_;
    record.velocity = velocity();
    record.pose_covariance.fill(std::nan(""));
    record.velocity_covariance.fill(std::nan(""));
    record.mean_residual_px = static_cast<float>(residual_px_);
}

std::unique_ptr<Estimator> make_gradient(TransformKind transform, const Contour& contour,
                                         const ObjectParameters& parameters, Pull pull) {
    switch (transform) {
        case TransformKind::isometry:
            return std::make_unique<GradientEstimator<TransformKind::isometry>>(contour, parameters,
                                                                                pull);
        case TransformKind::similarity:
            return std::make_unique<GradientEstimator<TransformKind::similarity>>(contour,
                                                                                  parameters, pull);
        case TransformKind::paper_affine:
            return std::make_unique<GradientEstimator<TransformKind::paper_affine>>(
                contour, parameters, pull);
        case TransformKind::full_affine:
            break;
    }
    return std::make_unique<GradientEstimator<TransformKind::full_affine>>(contour, parameters,
                                                                           pull);
}

}  // namespace pursuit::tracker
