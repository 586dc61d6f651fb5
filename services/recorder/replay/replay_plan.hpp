// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "services/common/result.hpp"
#include "services/recorder/replay/clock_steps.hpp"
#include "services/recorder/replay/planned_call.hpp"

namespace pursuit::recorder {

/// What one pass over a recording finds out before it is replayed.
struct ReplayPlan {
    std::map<std::uint32_t, std::deque<PlannedCall>> calls;  ///< By sensor id, in order.
    std::map<std::string, std::uint64_t> messages;           ///< By topic.
    std::vector<std::string> partitions;  ///< Named ones in which events were offered.
    std::vector<ClockStep> clock_steps;   ///< Of the host that recorded it.
    std::uint64_t gaps = 0;               ///< Breaks of event streams in the recording.
    std::uint64_t packets_missed = 0;     ///< In those gaps.
    std::uint64_t malformed = 0;          ///< Messages that are not of their topic's type.
    std::uint64_t unanswered = 0;         ///< Requests without a reply in the recording.
    std::uint64_t unasked = 0;            ///< Obeyed calls whose request is not in the recording.
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
