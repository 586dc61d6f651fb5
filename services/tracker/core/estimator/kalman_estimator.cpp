// SPDX-License-Identifier: Apache-2.0
// Where the filter begins, what it is told, and what it tells. (What events do: kalman_event.cpp.)
#include "services/tracker/core/estimator/kalman_estimator.hpp"

#include <Eigen/LU>
#include <cmath>

#include "services/tracker/core/estimator/told_covariance.hpp"
#include "services/tracker/core/noise/most_noise.hpp"

namespace pursuit::tracker {
namespace {

constexpr double same_edge_px = 8;  // a pixel's events within this way belong to one edge

// What the events of one passage over the pixels have in common (their grid, their thresholds, how
// early they come): so far off the pose is however steadily it goes. Of the discs' scenes, seeds 21
// to 26, told covariance and error agree with it in the mean.
constexpr double common_sigma_px = 0.034;

constexpr double start_pose_sigma_px = 1.2;
constexpr double start_speed_sigma_px_s = 3000;
constexpr double resumed_sigma_px = 0.7;
constexpr double resumed_sigma_of_way = 0.05;
constexpr double resumed_turn_sigma_px = 0.4;
constexpr double resumed_speed_sigma_px_s = 5;

}  // namespace

template <TransformKind kind>
KalmanEstimator<kind>::KalmanEstimator(const Contour& contour, const ObjectParameters& parameters)
    : contour_(contour),
      parameters_(parameters),
      parts_(parameters),
      bend_(contour_),
      offsets_(contour_, kind),
      quiet_(contour_),
      levels_(contour_),
      watch_(contour_) {
    LeadPhysics::prepare();
    set_parameters(parameters);
    restart({}, {});
}

template <TransformKind kind>
void KalmanEstimator<kind>::restart(const Pose& pose, const Velocity& velocity) {
    const double per_px = 1 / (contour_.gyration_px() * std::sqrt(std::abs(pose.a.determinant())));
    filter_.restart(pose, M::twist_of(velocity),
                    step_of(start_pose_sigma_px, start_pose_sigma_px * per_px),
                    step_of(start_speed_sigma_px_s, start_speed_sigma_px_s * per_px));
    measure_size();
    filter_.restart_leads(LeadPrior::mean_px(), LeadPrior::covariance_px2());
    lead_prior_.restart();
    trail_.restart();
    clock_.restart();
    pace_.restart();
    clutter_.restart();
    has_set_out_ = false;
    watch_.restart(pose, velocity);
    usual_way_ = {};
    stands_still_ = false;
    backlash_.restart(contour_.pieces().pieces().size());
    edge_polarity_.restart(contour_.pieces().pieces().size());
    contrast_.restart(contour_.pieces().pieces().size());
    bend_.restart();
    offsets_.restart();
    quiet_.restart();
    levels_.restart();
    // (A model of a recording's events lies where they come from.)
    noise_.restart(parts_.measurement_noise && !contour_.is_of_events());
    most_pose_sigma_px_ = usual_pose_sigma_px;
    residual_px_ = 0.5;
    t_us_ = -1;
    way_begin_ = pose;
    if constexpr (keeps_its_size) {
        lay_out();
    } else {
        // Of the rest the first event says how large it is.
        contour_.forget_excess(pose.a, Clutter::far_to_px + lay_out_spare_px);
        contour_.fit(pose.a, Clutter::far_to_px + lay_out_spare_px);
        sampled_for_area_ = 0;
    }
    begin_anew();
}

// Nothing is known of how it goes: what depends on it is asked for with the next event.
template <TransformKind kind>
void KalmanEstimator<kind>::begin_anew() {
    set_speed(0);
    unspread_s_ = 0;
    spread_after_s_ = 0;
    steadiness_.restart();
    find_silent_way();
}

template <TransformKind kind>
void KalmanEstimator<kind>::set_speed(double speed_px_s) {
    speed_px_s_ = speed_px_s;
    same_edge_us_ = 1e6 * same_edge_px / std::max(speed_px_s, 1e-3);
    contrast_.set_speed(speed_px_s);
    trail_.set_speed(speed_px_s);
    offsets_.set_speed(speed_px_s);
}

template <TransformKind kind>
void KalmanEstimator<kind>::resume(std::int64_t t_us, const Pose& pose, const Velocity& velocity,
                                   double way_px) {
    const double per_px = 1 / (contour_.gyration_px() * std::sqrt(std::abs(pose.a.determinant())));
    const double along_px = resumed_sigma_px + resumed_sigma_of_way * way_px;
    Step speed_sigma = step_of(resumed_speed_sigma_px_s, resumed_speed_sigma_px_s * per_px);
    if (usual_way_.is_known()) {
        speed_sigma.template head<2>().setConstant(usual_way_.strays_px_s);
        if constexpr (usual_components > 2) speed_sigma(2) = usual_way_.strays_rad_s;
    }
    filter_.restart(pose, M::twist_of(velocity),
                    step_of(resumed_sigma_px, resumed_turn_sigma_px * per_px), speed_sigma);
    Eigen::Vector2d direction(velocity.vx_px_s, velocity.vy_px_s);
    if (direction.norm() > 0) direction.normalize();
    filter_.add_position_variance((along_px * along_px - resumed_sigma_px * resumed_sigma_px) *
                                  direction * direction.transpose());
    measure_size();
    most_pose_sigma_px_ = std::max(usual_pose_sigma_px, along_px);
    levels_.restart();
    way_begin_ = pose;
    t_us_ = t_us;
    unspread_s_ = 0;
    spread_after_s_ = 0;
    steadiness_.restart();
}

template <TransformKind kind>
void KalmanEstimator<kind>::set_parameters(const ObjectParameters& parameters) {
    parameters_ = parameters;
    parts_ = KalmanParts(parameters);
    // A contour that lies where events came from has their leads in it.
    has_leads_ = parts_.leads && !contour_.is_of_events();
    // What a part had learnt goes with it.
    if (!parts_.steadiness) steadiness_.restart();
    if (!parts_.measurement_noise) noise_.restart(false);
    if (!parts_.noise_watch) watch_.restart(filter_.pose(), velocity());
    if (!parts_.offsets) offsets_.restart();
    if (!parts_.bend) bend_.restart();
}

template <TransformKind kind>
void KalmanEstimator<kind>::look_about(std::int64_t t_us, const RecentPixels& pixels) {
    const std::int64_t over_us = clutter_.asks_for_noise_of_us(t_us);
    if (over_us == 0) return;
    clutter_.bound_noise(
        t_us, most_noise_hz(t_us, over_us, filter_.pose().t_px, size_.extent_px, pixels));
}

template <TransformKind kind>
void KalmanEstimator<kind>::describe(std::int64_t t_us, PoseRecord& record) const {
    record.pose = filter_.pose();
    Step twist = filter_.twist();
    if (t_us_ >= 0) {
        const double dt_s = static_cast<double>(t_us - t_us_) * 1e-6;
        // Coasts as long as silence does not tell that it stands still.
        const double way2_px2 = dt_s * dt_s * own_speed2();
        const double moving_s =
            way2_px2 > silent_way2_px2_ ? dt_s * std::sqrt(silent_way2_px2_ / way2_px2) : dt_s;
        if (moving_s > 0) Filter::move(moving_s, record.pose, twist);
    }
    record.velocity = M::velocity(twist, record.pose.a);
    const double since_s = t_us_ < 0 ? 0 : static_cast<double>(t_us - t_us_) * 1e-6 + unspread_s_;
    constexpr double common_px2 = common_sigma_px * common_sigma_px;
    tell_covariance<kind>(filter_, since_s, step_of(common_px2, common_px2 * size_.per_gyration2),
                          record);
    record.mean_residual_px = static_cast<float>(residual_px_);
}

template class KalmanEstimator<TransformKind::isometry>;
template class KalmanEstimator<TransformKind::similarity>;
template class KalmanEstimator<TransformKind::paper_affine>;
template class KalmanEstimator<TransformKind::full_affine>;

}  // namespace pursuit::tracker
