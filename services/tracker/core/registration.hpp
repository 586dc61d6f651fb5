// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/tracker/core/geometry/pose.hpp"
#include "services/tracker/core/geometry/shape.hpp"
#include "services/tracker/core/kinds.hpp"
#include "services/tracker/core/parameters.hpp"

namespace pursuit::tracker {

/// Where an object begins.
struct Start {
    bool search = false;  ///< Found in the image by the tracker; pose and velocity are not used.
    Pose pose;
    Velocity velocity;

    friend bool operator==(const Start&, const Start&) = default;
};

/// The largest id that a caller may choose. Ids rise and are never used again: one choice must not
/// use up those that the tracker chooses.
constexpr std::uint32_t max_requested_id = INT32_MAX;

/// As the next object id: every id was used.
constexpr std::uint32_t no_object_id_left = UINT32_MAX;

/// An object to follow. Its name is the shape's.
struct Registration {
    /// 0: the tracker chooses the next. Else one not used before: from next_object_id() to
    /// max_requested_id; of those below it one of the last 1024 that were passed over; or,
    /// restoring what a former run had, below TrackerOptions::next_object_id and in rising order.
    std::uint32_t object_id = 0;
    Shape shape;  ///< Any origin: moved to the centre of gravity.
    TransformKind transform = TransformKind::isometry;
    EstimatorKind estimator = EstimatorKind::gradient;
    Start start;
    std::vector<NamedValue> parameters;  ///< Over those in force for new objects.
};

/// What a registration came to.
struct Registered {
    std::uint32_t object_id = 0;
    bool already_registered = false;  ///< Identical content was there before; nothing was changed.
};

/// Replaces shape, kinds and parameters of the object of the shape's name; its pose goes on.
struct ObjectUpdate {
    Shape shape;
    TransformKind transform = TransformKind::isometry;
    EstimatorKind estimator = EstimatorKind::gradient;
    std::vector<NamedValue> parameters;  ///< Over those in force for the object.
};

/// What is registered: the content of RegisteredModel (idl/models.idl).
struct RegisteredObject {
    std::uint32_t object_id = 0;
    Shape shape;                         ///< About the centre of gravity.
    std::int64_t effective_time_us = 0;  ///< Since when this holds.
    TransformKind transform = TransformKind::isometry;
    EstimatorKind estimator = EstimatorKind::gradient;
    Start start;                  ///< From where the object started at effective_time_us.
    ObjectParameters parameters;  ///< All in force; values() lists them by name.
};

/// What holds for the tracker as a whole: the content of TrackerSettings (idl/models.idl).
struct Settings {
    std::int64_t effective_time_us = 0;
    StrategyKind strategy = StrategyKind::closest;
    StrategyParameters strategy_parameters;
    TrackerParameters tracker;
    ObjectParameters new_objects;  ///< What a registration's parameters go over.
};

/// Where a track stands, for the store on disk and for a run after this.
struct TrackSnapshot {
    std::uint32_t object_id = 0;
    TrackState state = TrackState::searching;
    bool was_tracked = false;  ///< Whether the three below were ever set.
    std::int64_t t_us = 0;     ///< Of the pose.
    Pose pose;
    Velocity velocity;
};

}  // namespace pursuit::tracker
