// SPDX-License-Identifier: Apache-2.0
// What every event asks of the filter: how near it is, and what it tells.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "services/tracker/core/clamped.hpp"
#include "services/tracker/core/estimator/kalman_estimator.hpp"
#include "services/tracker/core/geometry/contour_place.hpp"

namespace pursuit::tracker {
namespace {

// Of the measurement.
constexpr double least_share = 0.05;
constexpr double least_lead_px = -1.2;
constexpr double most_lead_px = 1.6;
// What a level tells the place by: 0.1 px were the pose known when it was crossed before.
constexpr double level_sigma_px = 0.2;
constexpr double level_share = 0.5;  // an event of what is more likely something else tells of none

// Of the motion.
constexpr double bound_settles = 0.99;  // an event: the bound of the pose's σ back to the usual
constexpr double onset_px2 = 0.5;       // variance, when it begins to move out of noise
constexpr double onset_px_s = 200;      // σ of its speed then
}  // namespace

// Lookups and what is measured of the contour are good for the pose.
template <TransformKind kind>
void KalmanEstimator<kind>::lay_out() {
    const Eigen::Matrix2d& a = filter_.pose().a;
    contour_.fit(a, Clutter::far_to_px + lay_out_spare_px);
    const double area = a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0);
    if (std::abs(area - sampled_for_area_) < 0.3 * sampled_for_area_) return;
    clutter_.sample(contour_, a);
    sampled_for_area_ = area;
}

template <TransformKind kind>
void KalmanEstimator<kind>::measure_size() {
    const Eigen::Matrix2d& a = filter_.pose().a;
    const double area = std::abs(a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0));
    const double scale = std::sqrt(area);
    const double gyration_px = contour_.gyration_px();
    size_.length_px = 0.6 * contour_.length_px() * scale;
    size_.gyration_px = gyration_px * scale;
    size_.per_gyration2 = 1 / (gyration_px * gyration_px * area);
    size_.extent_px = contour_.radius_px() * a.norm();
    size_.near_px = contour_.radius_px() * largest_scale(a) + Clutter::far_to_px + 1;
    size_.watched_px = size_.extent_px + Clutter::far_to_px + 1;
}

template <TransformKind kind>
double KalmanEstimator<kind>::effective_length_px() const {
    return size_.length_px * visible_share_;
}

template <TransformKind kind>
[[gnu::always_inline]] inline void KalmanEstimator<kind>::predict_to(std::int64_t t_us) {
    if (!has_set_out_) {
        if (t_us_ >= 0) clock_.wait(static_cast<double>(t_us - t_us_) * 1e-6);
        t_us_ = t_us;
        unspread_s_ = 0;
        if (clutter_.is_measured()) set_out();
    }
    const double dt_s = static_cast<double>(t_us - t_us_) * 1e-6;
    if (!(dt_s > 0)) return;
    t_us_ = t_us;
    clock_.wait(dt_s);

    // Among noise alone nothing tells where it goes: it stands still until there is more.
    const bool stood_still = stands_still_;
    stands_still_ = sees_noise_alone();
    if (stands_still_) {
        filter_.slow_down(0);
        clock_.restart_rate();
        unspread_s_ = 0;
        return;
    }
    if (stood_still) {
        for (int i = 0; i < Filter::dof; ++i) {
            filter_.add_variance(i, onset_px2 * unit2(i));
            filter_.add_variance(Filter::dof + i, onset_px_s * onset_px_s * unit2(i));
        }
    }
    // It is told to move until so many events that should have come have not.
    unspread_s_ += dt_s;
    const double way2_px2 = dt_s * dt_s * own_speed2();
    filter_.advance(way2_px2 > silent_way2_px2_ ? dt_s * std::sqrt(silent_way2_px2_ / way2_px2)
                                                : dt_s);
    if (stood_still || unspread_s_ > spread_after_s_) {
        spread(unspread_s_);
        unspread_s_ = 0;
    }
}

// The pose of the last near event and how far the object can have gone since tell.
template <TransformKind kind>
double KalmanEstimator<kind>::reach_px(std::int64_t t_us) const {
    const double near_px = watch_.is_on() ? size_.watched_px : size_.near_px;
    return near_px + 2e-6 * speed_px_s_ * static_cast<double>(t_us - t_us_);
}

// Of what comes within the object's extent most is nowhere near its contour: that shows where it
// was last, as long as it cannot have gone far since. (Among noise all of it is looked at.)
template <TransformKind kind>
[[gnu::always_inline]] inline bool KalmanEstimator<kind>::is_far(const Eigen::Vector2d& q,
                                                                 double within_px) const {
    if (within_px - size_.near_px > lay_out_spare_px || watch_.is_on()) return false;
    const Eigen::Matrix2d& a = filter_.pose().a;
    const double per_area = keeps_its_size ? 1 : 1 / (a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0));
    return contour_.pieces().is_beyond((a(1, 1) * q.x() - a(0, 1) * q.y()) * per_area,
                                       (a(0, 0) * q.y() - a(1, 0) * q.x()) * per_area);
}

template <TransformKind kind>
double KalmanEstimator<kind>::lead_px(std::int32_t piece, int lead) const {
    const auto& leads_px = filter_.lead_px();
    const int first = lead & ~1;
    const double first_px = leads_px(first);
    const double subsequent_px = leads_px(first + 1);
    if (!parts_.contrast) return lead == first ? first_px : subsequent_px;
    const double earlier_px = contrast_.earlier(piece, first >> 1) * (first_px - subsequent_px);
    // Both: which of them it is, is known late.
    const double of_first_px = clamped(first_px + earlier_px, least_lead_px, most_lead_px);
    const double of_subsequent_px =
        clamped(subsequent_px + earlier_px, least_lead_px, most_lead_px);
    return lead == first ? of_first_px : of_subsequent_px;
}

template <TransformKind kind>
const Approach* KalmanEstimator<kind>::approach(const Event& event, const PixelPast& past) {
    Eigen::Vector2d q = Eigen::Vector2d(event.x, event.y) - filter_.pose().t_px;
    const double within_px = reach_px(event.t_us);
    if (q.squaredNorm() > within_px * within_px || is_far(q, within_px)) return nullptr;
    predict_to(event.t_us);
    const Pose& pose = filter_.pose();
    if constexpr (!keeps_its_size) lay_out();
    clutter_.reach(event.t_us);
    if (parts_.noise_watch && watch_.is_due(event.t_us)) look_out(event.t_us);
    if (watch_.is_on()) watch_.see(event);
    q = Eigen::Vector2d(event.x, event.y) - pose.t_px;
    if constexpr (is_bent) {
        // To where it would be, were the model not bent.
        if (!bend_.is_flat()) q -= pose.a * bend_.shift(pose.a.inverse() * q);
    }
    const ContourPlace place =
        place_on_contour<kind>(contour_.pieces(), pose.a, q, Clutter::far_to_px);
    if (place.piece < 0) return nullptr;
    const double past_end2 = place.squared_px - place.r_px * place.r_px;
    if (past_end2 > Clutter::overshoot_px * Clutter::overshoot_px) return nullptr;
    // (While this event's place is waited for. It brings a twentieth.)
    filter_.settle();

    const Segment& segment = contour_.pieces().segment(place.piece);
    const int polarity = event.polarity & 1;
    double h = 0;
    // With the polarity of the last event of its pixel, and with any.
    const bool follows_same = static_cast<double>(past.since_same_us) < same_edge_us_;
    const auto since_any_us = std::min(past.since_same_us, past.since_other_us);
    const bool follows_any = static_cast<double>(since_any_us) < same_edge_us_;
    bool subsequent = follows_same;
    measured_.settled_side = 0;
    measured_.of_polarity = 1;
    if (has_leads_) {
        // Where the edge turned back it is in the midst of the pixels that made its last events.
        // (As of the piece's last event: which lead it is shall not wait for the way since.)
        subsequent = backlash_.has_turned(place.piece) ? follows_any : follows_same;
        const Eigen::Vector2d middle(segment.ax + segment.dx / 2, segment.ay + segment.dy / 2);
        const double side =
            backlash_.gone(place.piece, pose.t_px, pose.a * middle, place.n, place.line_px);
        const auto told = edge_polarity_.tell(place.piece, polarity, side);
        h = parts_.polarity ? told.gone : side;
        if (parts_.polarity) measured_.of_polarity = told.likelihood;
        if (backlash_.is_settled(place.piece)) measured_.settled_side = side;
    }
    const int lead = 2 * polarity + (subsequent ? 1 : 0);
    const Step j = M::along(place.n, place.turning_px, place.arm_px, pose.a, place.model_px);
    double ahead_px = 0;
    bool is_late = false;
    // Where it goes on as it went, its velocity says how far since the pixel fired.
    measured_.has_way = parts_.trail && measured_.settled_side != 0 && std::abs(h) > 0.9;
    if (measured_.has_way) {
        measured_.way_px =
            1e-6 * static_cast<double>(since_any_us) * std::abs(j.dot(filter_.twist()));
        ahead_px = trail_.ahead(lead, measured_.way_px);
        is_late = Trail::is_late(lead, measured_.way_px);
    }
    measured_.gone = h;
    const double r_px =
        (place.r_px - offsets_.of(place.piece)) - (lead_px(place.piece, lead) + ahead_px) * h;
    const double distance_px = std::abs(r_px);
    if (distance_px > Clutter::far_from_px && distance_px < Clutter::far_to_px) {
        clutter_.count_far(place.piece, r_px);
    }
    if (distance_px > parameters_.gate_px) return nullptr;
    clutter_.pass_near();
    measured_.row = filter_.row(j, lead, h);
    if constexpr (is_bent) {
        measured_.along_bend = bend_.along(pose.a.transpose() * place.n, place.model_px);
    }
    measured_.r_px = r_px;
    measured_.has_side = segment.per_length2 > 0;
    measured_.lead = lead;
    measured_.event = event;
    measured_.since_us = since_any_us;
    measured_.place_px = place.r_px;
    measured_.along = j;
    measured_.told = noise_.at(r_px, measured_.row.h_p_h, subsequent || is_late);
    const double clutter =
        parts_.clutter ? clutter_.density(place.piece, r_px) : KalmanParts::usual_clutter;
    near_ = {r_px * r_px, clutter, true, r_px * r_px, place.piece};
    return &near_;
}

template <TransformKind kind>
[[gnu::noinline]] void KalmanEstimator<kind>::tell_leads() {
    constexpr bool is_size_known = kind == TransformKind::isometry;
    lead_prior_.look(t_us_, filter_.lead_px(), speed_px_s_, {clutter_.own_share(), noise_.gain()},
                     is_size_known);
    filter_.tell_leads(lead_prior_.weights(), lead_prior_.held_px(), LeadPrior::held_sigma_px);
    filter_.tell_leads(lead_prior_.apart_weights(), lead_prior_.apart_px(),
                       LeadPrior::apart_sigma_px);
    filter_.limit_leads(least_lead_px, most_lead_px);
}

template <TransformKind kind>
bool KalmanEstimator<kind>::take(double weight) {
    const double r = measured_.r_px;
    const MeasurementNoise::Told& told = measured_.told;
    const double of_own = told.likelihood() * measured_.of_polarity;
    const double share = weight * of_own / (of_own + near_.clutter);
    const bool is_told = clutter_.is_measured();
    clutter_.count_near(near_.piece, share);
    if (!has_set_out_) clock_.count(weight);
    if (!is_told || stands_still_ || share < least_share) return false;

    const double per_variance =
        weight * told.share_per_variance(measured_.of_polarity, near_.clutter, measured_.row.h_p_h);
    // Before the correction, which the next event waits for: it is done while that waits for its
    // quotients, and not after them.
    learn(r, share);
    if (watch_.helps()) {
        const double doubt = (1 / share - 1) * r * r * per_variance;
        filter_.correct(measured_.row, r, per_variance, 1 - doubt);
    } else if (share > level_share && measured_.has_side && uses_levels()) {
        correct_by_level(weight * share, per_variance);
    } else {
        filter_.correct(measured_.row, r, per_variance);
    }
    filter_.limit_leads(least_lead_px, most_lead_px);
    if constexpr (!keeps_its_size) measure_size();
    if constexpr (is_bent) {
        if (parts_.bend) {
            bend_.correct(measured_.along_bend, r, measured_.row.h_p_h + told.variance_px2(),
                          share);
        }
    }
    if (lead_prior_.count(measured_.lead, share) && parts_.lead_physics) tell_leads();
    most_pose_sigma_px_ =
        usual_pose_sigma_px + bound_settles * (most_pose_sigma_px_ - usual_pose_sigma_px);
    return true;
}

// The event tells where the edge is twice, by its lead and by the level. What both say is as one
// measurement, in which the lead has the smaller part: enough for what levels were wrong by to go.
template <TransformKind kind>
void KalmanEstimator<kind>::correct_by_level(double share, double per_variance) {
    constexpr double level_px2 = level_sigma_px * level_sigma_px;
    const double speed_px_s = measured_.along.dot(filter_.twist());
    const auto level = levels_.cross(measured_.event, measured_.since_us, near_.piece);
    typename Filter::Row both;
    const typename Filter::Row* row = &measured_.row;
    double r_px = measured_.r_px;
    bool is_right = true;
    if (level.is_known) {
        const double of_lead = level_px2 / (level_px2 + measured_.told.variance_px2());
        both = filter_.row(measured_.along, measured_.lead, measured_.gone * of_lead);
        const double beside_px = measured_.place_px - level.place_px;
        const double right = levels_.check(beside_px, both.h_p_h + level_px2);
        is_right = right > 0.5;
        if (is_right) {
            row = &both;
            r_px = beside_px + of_lead * (r_px - beside_px);
            per_variance = share * right / (both.h_p_h + (1 - of_lead) * level_px2);
        }
    }
    filter_.correct(*row, r_px, per_variance);
    levels_.learn(measured_.place_px - row->h_p_h * per_variance * r_px, speed_px_s, is_right);
}

// What the event says beside where the object is.
template <TransformKind kind>
[[gnu::always_inline]] inline void KalmanEstimator<kind>::learn(double r_px, double share) {
    clock_.count(share);
    quiet_.hear(near_.piece, share);
    if (parts_.measurement_noise) noise_.learn(r_px, measured_.told, share);
    residual_px_ += 0.01 * share * (std::abs(r_px) - residual_px_);
    if (parts_.offsets && measured_.has_side) offsets_.learn(near_.piece, r_px, share);
    // (Of what is not settled, nothing: nobody can foresee which it is.)
    const int polarity = measured_.lead >> 1;
    const double settled_share = std::abs(measured_.settled_side) >= 1 ? share : 0;
    edge_polarity_.learn(near_.piece, polarity, measured_.settled_side, settled_share);
    contrast_.count(near_.piece, polarity, (measured_.lead & 1) != 0, share);
    if (measured_.has_way) {
        trail_.learn(measured_.lead, measured_.way_px, r_px * measured_.gone, share);
    }
}

template void KalmanEstimator<TransformKind::isometry>::lay_out();
template void KalmanEstimator<TransformKind::isometry>::measure_size();
template double KalmanEstimator<TransformKind::isometry>::effective_length_px() const;
template double KalmanEstimator<TransformKind::isometry>::reach_px(std::int64_t) const;
template const Approach* KalmanEstimator<TransformKind::isometry>::approach(const Event&,
                                                                            const PixelPast&);
template bool KalmanEstimator<TransformKind::isometry>::take(double);
template void KalmanEstimator<TransformKind::similarity>::lay_out();
template void KalmanEstimator<TransformKind::similarity>::measure_size();
template double KalmanEstimator<TransformKind::similarity>::effective_length_px() const;
template double KalmanEstimator<TransformKind::similarity>::reach_px(std::int64_t) const;
template const Approach* KalmanEstimator<TransformKind::similarity>::approach(const Event&,
                                                                              const PixelPast&);
template bool KalmanEstimator<TransformKind::similarity>::take(double);
template void KalmanEstimator<TransformKind::paper_affine>::lay_out();
template void KalmanEstimator<TransformKind::paper_affine>::measure_size();
template double KalmanEstimator<TransformKind::paper_affine>::effective_length_px() const;
template double KalmanEstimator<TransformKind::paper_affine>::reach_px(std::int64_t) const;
template const Approach* KalmanEstimator<TransformKind::paper_affine>::approach(const Event&,
                                                                                const PixelPast&);
template bool KalmanEstimator<TransformKind::paper_affine>::take(double);
template void KalmanEstimator<TransformKind::full_affine>::lay_out();
template void KalmanEstimator<TransformKind::full_affine>::measure_size();
template double KalmanEstimator<TransformKind::full_affine>::effective_length_px() const;
template double KalmanEstimator<TransformKind::full_affine>::reach_px(std::int64_t) const;
template const Approach* KalmanEstimator<TransformKind::full_affine>::approach(const Event&,
                                                                               const PixelPast&);
template bool KalmanEstimator<TransformKind::full_affine>::take(double);

}  // namespace pursuit::tracker
