// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/track.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pursuit::tracker {
namespace {

// How often a good pose is kept for coasting.
constexpr std::int64_t keep_every_us = 30'000;

// How often the acquisition begins again at the coasted pose.
constexpr std::int64_t acquisition_us = 150'000;

// The events must speak against the pose for this long without a break: models taken from a real
// recording, and the first moments of slow objects among noise, do so for a while.
constexpr std::int64_t let_go_after_us = 100'000;

// In silence nothing tells that the object is still there.
constexpr double sure_s = 0.1;
constexpr double doubt_s = 0.3;

double seconds(std::int64_t us) { return static_cast<double>(us) * 1e-6; }

}  // namespace

Track::Track(const RegisteredObject& object, const TrackerParameters& tracker) : tracker_(tracker) {
    restart(object);
}

void Track::make_for(const RegisteredObject& object) {
    object_id_ = object.object_id;
    name_ = object.shape.name;
    transform_ = object.transform;
    parameters_ = object.parameters;
    estimator_ =
        make_estimator(object.estimator, object.transform, object.shape, object.parameters);
    acquisition_ = std::make_unique<Acquisition>(object);
    cover_ = std::make_unique<Cover>(Contour(object.shape));
}

void Track::replace(const RegisteredObject& object) {
    const PoseRecord last = record(last_event_t_us_);
    make_for(object);
    estimator_->restart(constrained(last.pose, transform_), last.velocity);
    if (is_acquiring_) acquisition_->begin(constrained(last.pose, transform_));
    for (Coast& good : good_) good.pose = constrained(good.pose, transform_);
}

void Track::set_parameters(const ObjectParameters& parameters, const TrackerParameters& tracker) {
    parameters_ = parameters;
    tracker_ = tracker;
    estimator_->set_parameters(parameters);
}

void Track::restart(const RegisteredObject& object) {
    make_for(object);
    is_searching_ = object.start.search;
    is_acquiring_ = false;
    is_fresh_ = true;
    against_since_us_ = -1;
    health_.restart();
    cover_->restart();
    estimator_->restart(object.start.pose, object.start.velocity);
    for (Coast& good : good_) good = {-1, object.start.pose, object.start.velocity};
}

void Track::begin_stream() {
    // A start pose that no event has moved yet was given for the stream that begins.
    if (is_searching_ || is_fresh_) return;
    // How long the sensor was away is not known: the last good pose, at rest.
    const Pose last = is_acquiring_ ? good_[1].pose : estimator_->pose();
    for (Coast& good : good_) good = {0, last, {}};
    last_event_t_us_ = 0;
    lose_grip(0);
}

void Track::remember_good(std::int64_t t_us) {
    if (good_[0].t_us >= 0 && t_us - good_[0].t_us < keep_every_us) return;
    PoseRecord now;
    estimator_->describe(t_us, now);
    good_[1] = good_[0].t_us < 0 ? Coast{t_us, now.pose, now.velocity} : good_[0];
    good_[0] = {t_us, now.pose, now.velocity};
}

void Track::lose_grip(std::int64_t t_us) {
    is_acquiring_ = true;
    against_since_us_ = -1;
    grip_lost_us_ = t_us;
    if (good_[1].t_us < 0) good_[1].t_us = t_us;
    acquisition_began_us_ = t_us;
    acquisition_->begin(coasted(t_us));
}

std::int64_t Track::speaks_against_for(std::int64_t t_us) {
    const bool against =
        health_.is_settled() && health_.is_against(parameters_.let_go_sharpness, cover_->share());
    if (!against) against_since_us_ = -1;
    if (against && against_since_us_ < 0) against_since_us_ = t_us;
    return against ? t_us - against_since_us_ : 0;
}

void Track::acquire(std::int64_t t_us) {
    is_acquiring_ = false;
    health_.restart(Health::good);
    cover_->restart();
    estimator_->restart(acquisition_->pose(), acquisition_->velocity());
    for (Coast& good : good_) good = {t_us, acquisition_->pose(), acquisition_->velocity()};
}

Pose Track::coasted(std::int64_t t_us) const {
    const Coast& from = good_[1];
    const double dt_s = std::clamp(seconds(t_us - from.t_us), 0.0, tracker_.coast_s);
    Pose pose = from.pose;
    pose.t_px += dt_s * Eigen::Vector2d(from.velocity.vx_px_s, from.velocity.vy_px_s);
    pose.a = rotation(from.velocity.omega_rad_s * dt_s) * pose.a;
    return pose;
}

Pose Track::pose() const { return is_acquiring_ ? acquisition_->pose() : estimator_->pose(); }

Approach Track::approach(const Event& event, std::int64_t since_same_us) {
    if (is_searching_) return {};
    if (!is_acquiring_) {
        const Approach near = estimator_->approach(event, since_same_us);
        distance_px_ = near.contour_px;
        piece_ = near.piece;
        return near;
    }
    const bool is_coasting = seconds(event.t_us - grip_lost_us_) < tracker_.coast_s;
    if (is_coasting && event.t_us - acquisition_began_us_ > acquisition_us) {
        acquisition_began_us_ = event.t_us;
        acquisition_->begin(coasted(event.t_us));
    }
    return acquisition_->approach(event);
}

bool Track::take(const Event& event, double weight) {
    is_fresh_ = false;
    if (is_acquiring_) {
        acquisition_->take();
        if (acquisition_->is_done()) acquire(event.t_us);
    } else {
        health_.count(distance_px_, parameters_.gate_px, event.t_us);
        if (parameters_.let_go_sharpness > 0 && speaks_against_for(event.t_us) > let_go_after_us) {
            lose_grip(event.t_us);
            return false;
        }
        // What is left in a quiet time is mostly noise: only what fits may move the pose.
        if (health_.is_quiet() && distance_px_ > parameters_.gate_px / 4) return false;
        if (!estimator_->take(weight)) return false;
        if (piece_ >= 0 && distance_px_ < parameters_.gate_px / 4) {
            cover_->count(piece_, estimator_->pose(), estimator_->velocity());
        }
        if (health_.is_fair() && against_since_us_ < 0) remember_good(event.t_us);
    }
    last_event_t_us_ = event.t_us;
    ++events_used_;
    return true;
}

TrackState Track::state_at(std::int64_t t_us) const {
    if (is_searching_) return TrackState::searching;
    if (!is_acquiring_) return TrackState::tracking;
    return seconds(t_us - grip_lost_us_) < tracker_.coast_s ? TrackState::occluded
                                                            : TrackState::lost;
}

double Track::confidence_at(std::int64_t t_us) const {
    if (is_searching_ || is_acquiring_) return 0;
    const double sharp = std::clamp((health_.sharpness() - 0.25) / 0.4, 0.0, 1.0);
    const double fit = std::min(sharp, std::clamp((cover_->share() - 0.4) / 0.2, 0.0, 1.0));
    const double silent_s = seconds(t_us - health_.lively_t_us()) - sure_s;
    return silent_s > 0 ? fit * std::exp(-silent_s / doubt_s) : fit;
}

PoseRecord Track::record(std::int64_t t_us) const {
    PoseRecord record;
    record.object_id = object_id_;
    record.t_us = t_us;
    record.last_event_t_us = last_event_t_us_;
    record.model = name_;
    record.transform = transform_;
    record.state = state_at(t_us);
    estimator_->describe(t_us, record);
    if (is_acquiring_) {
        record.pose = coasted(t_us);
        record.velocity = good_[1].velocity;
    }
    record.theta_rad = theta_rad(record.pose.a);
    record.scale_x = scale_x(record.pose.a);
    record.scale_y = scale_y(record.pose.a);
    record.confidence = static_cast<float>(confidence_at(t_us));
    record.events_used = events_used_;
    return record;
}

TrackSnapshot Track::snapshot() const {
    TrackSnapshot snapshot;
    snapshot.object_id = object_id_;
    snapshot.state = state_at(last_event_t_us_);
    snapshot.was_tracked = !is_searching_ && events_used_ > 0;
    snapshot.t_us = is_acquiring_ ? good_[1].t_us : last_event_t_us_;
    PoseRecord last;
    estimator_->describe(last_event_t_us_, last);
    snapshot.pose = is_acquiring_ ? good_[1].pose : last.pose;
    snapshot.velocity = is_acquiring_ ? good_[1].velocity : last.velocity;
    return snapshot;
}

}  // namespace pursuit::tracker
