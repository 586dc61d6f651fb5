// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "services/common/event.hpp"
#include "services/tracker/core/acquisition.hpp"
#include "services/tracker/core/cover.hpp"
#include "services/tracker/core/estimator.hpp"
#include "services/tracker/core/health.hpp"
#include "services/tracker/core/pose_record.hpp"
#include "services/tracker/core/registration.hpp"

namespace pursuit::tracker {

/// One object being followed: its estimator and its life.
///
///     SEARCHING ── a pose is given ──► TRACKING ── events stop matching ──► OCCLUDED
///                                          ▲                                   │ coast_s
///                                          └──── acquired again ──── LOST ◄────┘
///
/// While the events match, the estimator has them. When they stop matching, the last good pose
/// coasts on its velocity and the acquisition has the events, from where the coast is, again and
/// again; LOST says that coasting went on too long, and the acquisition still goes on. No events at
/// all are no mismatch: an object that stands still stays TRACKING, with falling confidence.
class Track {
 public:
    Track(const RegisteredObject& object, const TrackerParameters& tracker);

    /// Takes new content; the pose goes on.
    void replace(const RegisteredObject& object);
    /// Takes new parameters; everything goes on.
    void set_parameters(const ObjectParameters& parameters, const TrackerParameters& tracker);
    /// Begins anew at the start.
    void restart(const RegisteredObject& object);
    /// Event time begins anew; the pose is looked for around the last.
    void begin_stream();

    [[nodiscard]] std::uint32_t object_id() const { return object_id_; }
    [[nodiscard]] Pose pose() const;

    /// How near an event is. take() uses the event that approach() was asked for last.
    Approach approach(const Event& event, std::int64_t since_same_us);
    bool take(const Event& event, double weight);

    /// What is known at a grid time at or after the last event.
    [[nodiscard]] PoseRecord record(std::int64_t t_us) const;
    [[nodiscard]] TrackSnapshot snapshot() const;

 private:
    /// A pose at a time, and where it goes from there.
    struct Coast {
        std::int64_t t_us = 0;
        Pose pose;
        Velocity velocity;
    };

    void make_for(const RegisteredObject& object);
    void remember_good(std::int64_t t_us);
    /// How long the events have spoken against the pose, now included, µs.
    std::int64_t speaks_against_for(std::int64_t t_us);
    void lose_grip(std::int64_t t_us);
    void acquire(std::int64_t t_us);
    [[nodiscard]] Pose coasted(std::int64_t t_us) const;
    [[nodiscard]] TrackState state_at(std::int64_t t_us) const;
    [[nodiscard]] double confidence_at(std::int64_t t_us) const;

    std::uint32_t object_id_ = 0;
    std::string name_;
    TransformKind transform_ = TransformKind::isometry;
    ObjectParameters parameters_;
    TrackerParameters tracker_;
    std::unique_ptr<Estimator> estimator_;
    std::unique_ptr<Acquisition> acquisition_;
    Health health_;
    std::unique_ptr<Cover> cover_;
    std::int32_t piece_ = -1;
    bool is_searching_ = false;
    bool is_acquiring_ = false;
    bool is_fresh_ = true;  // since the restart no event was taken
    std::int64_t against_since_us_ = -1;
    Coast good_[2];  // the last, and the one before: older than what made the events mismatch
    std::int64_t grip_lost_us_ = 0;
    std::int64_t acquisition_began_us_ = 0;
    double distance_px_ = 0;
    std::int64_t last_event_t_us_ = 0;
    std::uint64_t events_used_ = 0;
};

}  // namespace pursuit::tracker
