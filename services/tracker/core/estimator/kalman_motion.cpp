// SPDX-License-Identifier: Apache-2.0
// How it sets out, is sighted again, and is spread as time goes on: how the object can have turned
// away, how fast it is by its events, and what their silence tells. (Apart from what each event
// does.)
#include <algorithm>
#include <cmath>

#include "services/tracker/core/estimator/kalman_estimator.hpp"

namespace pursuit::tracker {
namespace {

constexpr double kappa = 0.15;  // px^-1/2
// Where all events cross levels again, q may be so many times the usual. What trembles before a
// camera by half a pixel at 4 to 11 Hz has 40 times as much of it, with a third of its events. From
// 15 to 100 it is much the same.
constexpr double turns_back = 40;
constexpr double still_px_s = 10;  // v0
constexpr double lead_drift_px2_s = 1e-3;
constexpr double silent_events = 10;  // expected and not come: it stands still
// The mean goes on with every event, what is known of it (its covariance, and how it can turn away)
// after so much of a way or time.
constexpr double spread_way_px = 0.05;
constexpr double spread_s = 0.002;
// As it sets out it goes no faster than so many times what its events tell (they may be fewer than
// usual), and this.
constexpr double times_told = 3;
constexpr double set_out_px_s = 30;
// Among strong noise.
constexpr double sighted_sigma_px = 0.6;
constexpr double sighted_speed_sigma_px_s = 100;

}  // namespace

// Until it is known what is clutter it stands where it was put. How many events came meanwhile says
// how fast it can be: else the first few, each a part of a pixel beside the contour, would tell of
// thousands of px/s, and a model that is a pixel wrong would turn and shift before the next come.
template <TransformKind kind>
[[gnu::noinline]] void KalmanEstimator<kind>::set_out() {
    has_set_out_ = true;
    clock_.begin_way();
    if (!parts_.event_clock || !clock_.is_told()) return;
    const double fastest_px_s =
        times_told * clock_.speed_px_s(effective_length_px()) + set_out_px_s;
    for (int i = 0; i < Filter::dof; ++i) {
        filter_.limit_variance(Filter::dof + i, fastest_px_s * fastest_px_s * unit2(i));
    }
}

template <TransformKind kind>
void KalmanEstimator<kind>::look_out(std::int64_t t_us) {
    const Coast own{t_us, filter_.pose(), velocity()};
    const auto to = watch_.look(own, clutter_, visible_share_, size_.gyration_px, size_.extent_px);
    if (!to) return;
    const double per_px = 1 / size_.gyration_px;
    filter_.restart(to->pose, M::twist_of(to->velocity),
                    step_of(sighted_sigma_px, sighted_sigma_px * per_px),
                    step_of(sighted_speed_sigma_px_s, sighted_speed_sigma_px_s * per_px));
    levels_.restart();
    unspread_s_ = 0;
    spread_after_s_ = 0;
    steadiness_.restart();
    // It did not go this way event by event.
    clock_.begin_way();
    way_begin_ = to->pose;
}

template <TransformKind kind>
void KalmanEstimator<kind>::spread(double dt_s) {
    const double length_px = effective_length_px();
    const Pose& pose = filter_.pose();
    const double gyration_px = contour_.gyration_px();
    const double way2 = (pose.t_px - way_begin_.t_px).squaredNorm() +
                        0.5 * gyration_px * gyration_px * (pose.a - way_begin_.a).squaredNorm();
    if (clock_.end_way(way2, length_px)) {
        clock_.begin_way();
        way_begin_ = pose;
    }
    const double own_px_s = std::sqrt(own_speed2());
    const double told_px_s = parts_.event_clock ? clock_.speed_px_s(length_px) : own_px_s;
    const double at_most = std::max(std::min(own_px_s, 2 * told_px_s), told_px_s);
    set_speed(std::sqrt(at_most * at_most + still_px_s * still_px_s));
    pace_.go(dt_s, speed_px_s_);
    const double pace_px_s =
        parts_.pace ? pace_.px_s(speed_px_s_, clutter_.own_share()) : speed_px_s_;
    // What shows of it by half tells by half where it turns.
    const double q =
        kappa * kappa * pace_px_s * pace_px_s * pace_px_s * visible_share_ * visible_share_;
    Step noise = step_of(q, q * size_.per_gyration2);
    if constexpr (kind == TransformKind::similarity) noise(3) *= 0.2 * 0.2;
    if constexpr (kind == TransformKind::paper_affine) noise.template tail<2>() *= 0.7 * 0.7;
    if constexpr (kind == TransformKind::full_affine) noise.template tail<4>() *= 0.7 * 0.7;
    // What turns back and forth may turn more than usual. (Of others what the model is wrong by
    // would be taken for turning.)
    const double most_share = uses_levels() ? 1 + turns_back * levels_.crossed_again() : 1;
    if (parts_.steadiness) {
        steadiness_.go(pace_px_s * dt_s, M::omega(filter_.twist()) * dt_s, filter_.twist(),
                       noise * dt_s, most_share);
    }
    noise = noise.cwiseProduct(steadiness_.share());
    if constexpr (is_bent) bend_.predict(speed_px_s_ * dt_s);
    if (visible_share_ < UsualWay::least_seen_share && usual_way_.is_known()) {
        go_as_usual(dt_s, noise);
    }
    filter_.spread(dt_s, noise);

    // Silence means standing still; less so where what is hidden, and whose the events beside it
    // are, is known by half only. (With 0.3 a car fell behind half way under a van.)
    const double still_share = visible_share_ < 0.95 ? 0.1 : 0.6;
    if (own_px_s > 0 && told_px_s < still_share * own_px_s) {
        const double missed = dt_s * clock_.events_per_px(length_px) * own_px_s;
        const double f =
            std::min(1.0, missed / silent_events) * (1 - told_px_s / own_px_s / still_share);
        filter_.slow_down(1 - f);
        for (int i = 0; i < Filter::dof; ++i) {
            filter_.add_variance(Filter::dof + i, f * own_px_s * own_px_s * unit2(i));
        }
    }
    if (parts_.quiet_facings && quiet_.wait(dt_s))
        quiet_.look(filter_, size_.per_gyration2, visible_share_ > 0.95 && watch_.knows_silence());
    const double speed_sigma = std::max(told_px_s, std::min(own_px_s, 3 * told_px_s)) + 30;
    for (int i = 0; i < Filter::dof; ++i) {
        filter_.limit_variance(i, most_pose_sigma_px_ * most_pose_sigma_px_ * unit2(i));
        if (parts_.event_clock && clock_.is_told()) {
            filter_.limit_variance(Filter::dof + i, speed_sigma * speed_sigma * unit2(i));
        }
    }
    for (int i = 0; i < Filter::leads; ++i) {
        filter_.add_variance(2 * Filter::dof + i, lead_drift_px2_s * dt_s);
    }
    steadiness_.begin(filter_.twist());
    // Of a way, or of what the way is uncertain by: at a start nobody knows the speed.
    const double may_go_px_s = std::sqrt(
        speed_px_s_ * speed_px_s_ + filter_.speed_variance(size_.gyration_px * size_.gyration_px));
    spread_after_s_ = std::min(spread_s, spread_way_px / may_go_px_s);
    find_silent_way();
}

// A velocity that strays from the usual one for a while (Ornstein and Uhlenbeck's process).
template <TransformKind kind>
void KalmanEstimator<kind>::go_as_usual(double dt_s, Step& noise) {
    constexpr double for_s = UsualWay::strays_for_s;
    const double kept = std::exp(-dt_s / for_s);
    const Step to = M::twist_of(usual_way_.velocity);
    for (int i = 0; i < usual_components; ++i) {
        const double strays = i < 2 ? usual_way_.strays_px_s : usual_way_.strays_rad_s;
        noise(i) = std::min(noise(i), 2 * strays * strays / for_s);
        filter_.draw_twist(i, to(i), kept);
    }
}

template <TransformKind kind>
void KalmanEstimator<kind>::find_silent_way() {
    const double way_px = silent_events / clock_.events_per_px(effective_length_px());
    silent_way2_px2_ = way_px * way_px;
}

template void KalmanEstimator<TransformKind::isometry>::set_out();
template void KalmanEstimator<TransformKind::isometry>::look_out(std::int64_t);
template void KalmanEstimator<TransformKind::isometry>::spread(double);
template void KalmanEstimator<TransformKind::isometry>::find_silent_way();
template void KalmanEstimator<TransformKind::similarity>::set_out();
template void KalmanEstimator<TransformKind::similarity>::look_out(std::int64_t);
template void KalmanEstimator<TransformKind::similarity>::spread(double);
template void KalmanEstimator<TransformKind::similarity>::find_silent_way();
template void KalmanEstimator<TransformKind::paper_affine>::set_out();
template void KalmanEstimator<TransformKind::paper_affine>::look_out(std::int64_t);
template void KalmanEstimator<TransformKind::paper_affine>::spread(double);
template void KalmanEstimator<TransformKind::paper_affine>::find_silent_way();
template void KalmanEstimator<TransformKind::full_affine>::set_out();
template void KalmanEstimator<TransformKind::full_affine>::look_out(std::int64_t);
template void KalmanEstimator<TransformKind::full_affine>::spread(double);
template void KalmanEstimator<TransformKind::full_affine>::find_silent_way();

}  // namespace pursuit::tracker
