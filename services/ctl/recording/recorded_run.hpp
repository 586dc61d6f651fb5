// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models.h"
#include "poses.h"
#include "services/common/event.hpp"
#include "services/common/result.hpp"
#include "status.h"

namespace pursuit::ctl {

/// One recorded pose, as far as a report needs it.
struct RecordedPose {
    std::int64_t t_us = 0;
    v1::TrackState state = v1::TRACK_SEARCHING;
    double x_px = 0, y_px = 0, a00 = 1, a01 = 0, a10 = 0, a11 = 1;
    double confidence = 0;
};

/// The events before a time, for a picture.
struct RecordedSlice {
    std::int64_t begin_us = 0;
    std::int64_t end_us = 0;
    std::vector<Event> events;
};

/// What a recording of the three services tells about one run. Where several streams were recorded
/// it is the last one's.
struct RecordedRun {
    Geometry geometry;
    std::uint64_t stream_id = 0;
    std::uint64_t packets = 0;
    std::uint64_t events = 0;
    std::uint64_t packets_missing = 0;  ///< Breaks of the sequence number of the events.
    std::uint64_t poses_missing = 0;    ///< Likewise of the poses, all objects.
    std::uint64_t calls_missing = 0;    ///< Calls that the tracker obeyed; their replies are there.
    std::optional<std::int64_t> first_t_us, last_t_us;
    std::map<std::int64_t, std::uint64_t> events_per_bin;  ///< By the begin of the bin, µs.
    static constexpr std::int64_t bin_us = 50'000;

    std::map<std::uint32_t, v1::RegisteredModel> models;           ///< By object id; the last.
    std::map<std::uint32_t, std::vector<RecordedPose>> poses;      ///< By object id, in order.
    std::vector<std::pair<std::int64_t, std::string>> strategies;  ///< Effective time, name.
    std::optional<v1::SensorStatus> sensor;                        ///< The last words of each.
    std::optional<v1::TrackerStatus> tracker;
    std::optional<v1::RecorderStatus> recorder;
    std::vector<RecordedSlice> slices;
    /// Of the file, and what was left out: what is here is good all the same.
    std::vector<std::string> faults;
};

/// Reads a recording twice: once for all but the slices, and once for `slices` of them, evenly over
/// the time that has poses, each of `slice_us`. Memory is bounded by the poses (what is more than
/// `most_poses` is left out and told among the faults) and the events of the slices (at most
/// 200,000 each; what is more is left out of the picture).
Result<RecordedRun> read_run(const std::string& path, std::size_t slices, std::int64_t slice_us,
                             std::size_t most_poses = 10'000'000);

}  // namespace pursuit::ctl
