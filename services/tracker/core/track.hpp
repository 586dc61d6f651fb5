// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/pose_record.hpp"
#include "services/tracker/core/registration.hpp"

namespace pursuit::tracker {

/// One object being followed: its model, its pose and its life.
class Track {
 public:
    explicit Track(const RegisteredObject& object);

    /// Takes new content; the pose goes on.
    void replace(const RegisteredObject& object);
    /// Begins anew at the start.
    void restart(const RegisteredObject& object);
    void begin_stream();

    [[nodiscard]] std::uint32_t object_id() const { return object_id_; }
    [[nodiscard]] const Pose& pose() const { return pose_; }

    /// Distance of an event to the nearest model point, px; remembers that point.
    double nearest(const Event& event);
    [[nodiscard]] double gate_px() const { return parameters_.gate_px; }
    /// Moves the pose by the event that nearest() was asked for last.
    void update(const Event& event);

    /// What is known at a grid time at or after the last event.
    [[nodiscard]] PoseRecord record(std::int64_t t_us) const;
    [[nodiscard]] TrackSnapshot snapshot() const;

 private:
    std::uint32_t object_id_ = 0;
    std::string name_;
    TransformKind transform_ = TransformKind::isometry;
    ObjectParameters parameters_;
    std::vector<Eigen::Vector2d> points_px_;
    Pose pose_;
    bool searching_ = false;
    std::int64_t last_event_t_us_ = 0;
    std::uint64_t events_used_ = 0;
    double residual_px_ = 0;
    double nearest_px_ = 0;
    Eigen::Vector2d nearest_model_px_ = Eigen::Vector2d::Zero();
};

}  // namespace pursuit::tracker
