// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/track.hpp"

#include <cmath>

namespace pursuit::tracker {

Track::Track(const RegisteredObject& object) { restart(object); }

void Track::make_estimator_for(const RegisteredObject& object) {
    object_id_ = object.object_id;
    name_ = object.shape.name;
    transform_ = object.transform;
    estimator_ =
        make_estimator(object.estimator, object.transform, object.shape, object.parameters);
}

void Track::replace(const RegisteredObject& object) {
    const PoseRecord last = record(last_event_t_us_);
    make_estimator_for(object);
    estimator_->restart(constrained(last.pose, transform_), last.velocity);
}

void Track::set_parameters(const ObjectParameters& parameters) {
    estimator_->set_parameters(parameters);
}

void Track::restart(const RegisteredObject& object) {
    make_estimator_for(object);
    searching_ = object.start.search;
    estimator_->restart(object.start.pose, object.start.velocity);
}

void Track::begin_stream() {
    const PoseRecord last = record(last_event_t_us_);
    last_event_t_us_ = 0;
    estimator_->restart(last.pose, {});
}

double Track::approach(const Event& event, std::int64_t since_same_us) {
    if (searching_) return Estimator::beyond;
    return estimator_->approach(event, since_same_us);
}

bool Track::take(const Event& event, double weight) {
    if (!estimator_->take(weight)) return false;
    last_event_t_us_ = event.t_us;
    ++events_used_;
    return true;
}

PoseRecord Track::record(std::int64_t t_us) const {
    PoseRecord record;
    record.object_id = object_id_;
    record.t_us = t_us;
    record.last_event_t_us = last_event_t_us_;
    record.model = name_;
    record.transform = transform_;
    record.state = searching_ ? TrackState::searching : TrackState::tracking;
    estimator_->describe(t_us, record);
    record.theta_rad = theta_rad(record.pose.a);
    record.scale_x = scale_x(record.pose.a);
    record.scale_y = scale_y(record.pose.a);
    record.confidence = searching_ ? 0.0F : 0.9F;
    record.events_used = events_used_;
    return record;
}

TrackSnapshot Track::snapshot() const {
    const PoseRecord last = record(last_event_t_us_);
    TrackSnapshot snapshot;
    snapshot.object_id = object_id_;
    snapshot.state = last.state;
    snapshot.was_tracked = !searching_ && events_used_ > 0;
    snapshot.t_us = last_event_t_us_;
    snapshot.pose = last.pose;
    snapshot.velocity = last.velocity;
    return snapshot;
}

}  // namespace pursuit::tracker
