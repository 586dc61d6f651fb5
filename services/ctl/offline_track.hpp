// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config.pb.h"
#include "services/common/event.hpp"
#include "services/common/result.hpp"
#include "services/sensor/range_reader.hpp"
#include "services/tracker/core/kinds.hpp"
#include "services/tracker/core/tracker.hpp"

namespace pursuit::ctl {

/// What to follow in which recording.
struct OfflineTrack {
    std::string events;
    std::vector<std::string>
        models;                  ///< PATH[@x,y,theta[,scale]], after those of the configuration.
    disk::TrackerConfig config;  ///< Of the tracker; what concerns DDS and the store is unused.
    std::string config_path;     ///< The file that it was read from; empty: none.
    /// Of every object; without: as the service takes those of its configuration.
    std::optional<tracker::TransformKind> transform;
    std::optional<tracker::EstimatorKind> estimator;
    sensor::TimeRange range;
    std::optional<Geometry> geometry;
    std::string poses;  ///< The table to write.
};

struct OfflineTrackSummary {
    tracker::TrackerCounters counters;
    std::vector<tracker::TrackSnapshot> objects;  ///< At the end.
    double wall_s = 0;
};

/// Follows the models through a recording as fast as it goes: the core of the service, in this
/// thread, with the poses that the service would publish. After an error in the recording the poses
/// up to there are in the table.
Result<OfflineTrackSummary> track_offline(const OfflineTrack& task);

}  // namespace pursuit::ctl
