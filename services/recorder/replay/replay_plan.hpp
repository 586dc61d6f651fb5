// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "services/common/result.hpp"
#include "tracker_requests.h"

namespace pursuit::recorder {

/// A call on the tracker that belongs to a recording: one that was recorded with its reply, or one
/// that brings about what held before the recording began.
struct PlannedCall {
    v1::TrackerRequest request;  ///< apply_at_us is the recorded reply's effective_time_us.
    std::string name;            ///< For messages: "register model car at 1560000 us".
    std::size_t stream = 0;      ///< It holds in this stream of its sensor, counted from 0.
    std::size_t order = 0;       ///< Among those of the same time.
};

/// What one pass over a recording finds out before it is replayed.
struct ReplayPlan {
    std::map<std::uint32_t, std::deque<PlannedCall>> calls;  ///< By sensor id, in order.
    std::map<std::string, std::uint64_t> messages;           ///< By topic.
    std::vector<std::string> partitions;  ///< Named ones in which events were offered.
    std::uint64_t gaps = 0;               ///< Breaks of event streams in the recording.
    std::uint64_t packets_missed = 0;     ///< In those gaps.
    std::uint64_t malformed = 0;          ///< Messages that are not of their topic's type.
    std::uint64_t unanswered = 0;         ///< Requests without a reply in the recording.
    std::string damage;                   ///< Of the file; empty when it is sound to its end.

    std::size_t call_count() const {
        std::size_t count = 0;
        for (const auto& [sensor_id, of_sensor] : calls) count += of_sensor.size();
        return count;
    }
};

/// Reads the whole recording, or until `stopped`. An error only where nothing of it can be read.
Result<ReplayPlan> make_plan(const std::string& path, const std::function<bool()>& stopped);

}  // namespace pursuit::recorder
