// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "services/common/event.hpp"
#include "services/tracker/core/estimator.hpp"
#include "services/tracker/core/pose_record.hpp"
#include "services/tracker/core/registration.hpp"

namespace pursuit::tracker {

/// One object being followed: its estimator and its life.
class Track {
 public:
    explicit Track(const RegisteredObject& object);

    /// Takes new content; the pose goes on.
    void replace(const RegisteredObject& object);
    /// Takes new parameters; everything goes on.
    void set_parameters(const ObjectParameters& parameters);
    /// Begins anew at the start.
    void restart(const RegisteredObject& object);
    void begin_stream();

    [[nodiscard]] std::uint32_t object_id() const { return object_id_; }
    [[nodiscard]] const Pose& pose() const { return estimator_->pose(); }

    /// As Estimator's.
    double approach(const Event& event, std::int64_t since_same_us);
    bool take(const Event& event, double weight);

    /// What is known at a grid time at or after the last event.
    [[nodiscard]] PoseRecord record(std::int64_t t_us) const;
    [[nodiscard]] TrackSnapshot snapshot() const;

 private:
    void make_estimator_for(const RegisteredObject& object);

    std::uint32_t object_id_ = 0;
    std::string name_;
    TransformKind transform_ = TransformKind::isometry;
    std::unique_ptr<Estimator> estimator_;
    bool searching_ = false;
    std::int64_t last_event_t_us_ = 0;
    std::uint64_t events_used_ = 0;
};

}  // namespace pursuit::tracker
