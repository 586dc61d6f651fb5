// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

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

/// How many calls of a recording are remembered, so that no file exhausts the memory: a register
/// call is up to 50 kB.
inline constexpr std::size_t most_planned_calls = 10'000;

/// The name of a call that changes the tracker, as PlannedCall has it.
std::string name_of(const v1::TrackerRequest& request);

}  // namespace pursuit::recorder
