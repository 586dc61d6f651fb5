// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include "services/tracker/core/geometry/pose.hpp"
#include "services/tracker/core/kinds.hpp"

namespace pursuit::tracker {

/// One pose on the event-time grid: everything of ObjectPose (idl/poses.idl) but the sensor id, the
/// sequence number and the host time, which are the publisher's.
struct PoseRecord {
    std::uint32_t object_id = 0;
    std::uint64_t stream_id = 0;
    std::int64_t t_us = 0;             ///< Grid time; the state after the last event before it.
    std::int64_t last_event_t_us = 0;  ///< Of the last event the pose has used; 0 where none yet.
    std::string_view model;            ///< Valid during the call that hands the record over.
    TransformKind transform = TransformKind::isometry;
    TrackState state = TrackState::searching;
    LossCause loss_cause = LossCause::not_lost;
    Pose pose;
    double theta_rad = 0;
    double scale_x = 1;
    double scale_y = 1;
    Velocity velocity;
    /// Upper triangles, row by row, NaN where the estimator has none. Pose: x, y [px], theta [rad],
    /// log scale_x, log scale_y, shear. Velocity: vx, vy [px/s], omega [rad/s].
    std::array<double, 21> pose_covariance{};
    std::array<double, 6> velocity_covariance{};
    float confidence = 0;           ///< 0 … 1; above 0.5 only while the events match the pose.
    float mean_residual_px = 0;     ///< Recent mean distance of the object's events to the model.
    float event_rate_hz = 0;        ///< Recent rate of the object's events.
    std::uint64_t events_used = 0;  ///< Since registration.
};

/// One step of one object, made by one event.
struct UpdateRecord {
    std::uint32_t object_id = 0;
    std::uint64_t stream_id = 0;
    std::int64_t t_us = 0;
    Pose pose;
};

/// Takes what the tracker makes, on the thread that calls the tracker, in order of time and, at one
/// time, of object ids. Must not call the tracker.
class PoseSink {
 public:
    virtual ~PoseSink() = default;
    virtual void pose(const PoseRecord& record) = 0;

    /// Every step of every object; only with TrackerOptions::emit_updates.
    virtual void update(const UpdateRecord& record) { static_cast<void>(record); }
};

}  // namespace pursuit::tracker
