// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/track.hpp"

#include <cmath>

namespace pursuit::tracker {

Track::Track(const RegisteredObject& object) { restart(object); }

void Track::replace(const RegisteredObject& object) {
    object_id_ = object.object_id;
    name_ = object.shape.name;
    transform_ = object.transform;
    parameters_ = object.parameters;
    points_px_.clear();
    for (const auto& point : object.shape.points_px) points_px_.push_back(point.cast<double>());
    pose_ = constrained(pose_, transform_);
}

void Track::restart(const RegisteredObject& object) {
    replace(object);
    pose_ = object.start.pose;
    searching_ = object.start.search;
}

void Track::begin_stream() { last_event_t_us_ = 0; }

double Track::nearest(const Event& event) {
    double best = 1e300;
    const Eigen::Vector2d p(event.x, event.y);
    for (const auto& m : points_px_) {
        const double d = (p - pose_.t_px - pose_.a * m).squaredNorm();
        if (d < best) {
            best = d;
            nearest_model_px_ = m;
        }
    }
    nearest_px_ = std::sqrt(best);
    return nearest_px_;
}

void Track::update(const Event& event) {
    const Eigen::Vector2d q = Eigen::Vector2d(event.x, event.y) - pose_.t_px;
    const Eigen::Vector2d m = pose_.a * nearest_model_px_;
    const Eigen::Vector2d r = q - m;
    pose_.t_px += 2 * parameters_.gradient_position_gain * r;
    const double turn =
        2 * parameters_.gradient_angle_gain_rad_px2 * (m.x() * q.y() - m.y() * q.x());
    double grow = 1;
    if (transform_ != TransformKind::isometry) {
        grow += parameters_.gradient_scale_gain_1_px * (q.norm() - m.norm());
    }
    pose_.a = rotation(turn) * pose_.a * grow;
    residual_px_ += 0.01 * (nearest_px_ - residual_px_);
    last_event_t_us_ = event.t_us;
    ++events_used_;
}

PoseRecord Track::record(std::int64_t t_us) const {
    PoseRecord record;
    record.object_id = object_id_;
    record.t_us = t_us;
    record.last_event_t_us = last_event_t_us_;
    record.model = name_;
    record.transform = transform_;
    record.state = searching_ ? TrackState::searching : TrackState::tracking;
    record.pose = pose_;
    record.theta_rad = theta_rad(pose_.a);
    record.scale_x = scale_x(pose_.a);
    record.scale_y = scale_y(pose_.a);
    record.pose_covariance.fill(std::nan(""));
    record.velocity_covariance.fill(std::nan(""));
    record.confidence = searching_ ? 0.0F : 0.9F;
    record.mean_residual_px = static_cast<float>(residual_px_);
    record.events_used = events_used_;
    return record;
}

TrackSnapshot Track::snapshot() const {
    TrackSnapshot snapshot;
    snapshot.object_id = object_id_;
    snapshot.state = searching_ ? TrackState::searching : TrackState::tracking;
    snapshot.was_tracked = !searching_ && events_used_ > 0;
    snapshot.t_us = last_event_t_us_;
    snapshot.pose = pose_;
    return snapshot;
}

}  // namespace pursuit::tracker
