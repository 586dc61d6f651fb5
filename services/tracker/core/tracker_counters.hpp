// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "services/tracker/core/kinds.hpp"

namespace pursuit::tracker {

/// Running totals since construction. events_in = events_used + events_unused + the dropped ones.
struct TrackerCounters {
    std::uint64_t events_in = 0;
    std::uint64_t events_used = 0;                ///< By at least one object.
    std::uint64_t events_unused = 0;              ///< Near no object, or refused by all.
    std::uint64_t dropped_outside_geometry = 0;   ///< Pixel beyond the stream's width or height.
    std::uint64_t dropped_time_went_back = 0;     ///< Earlier than an event or advance() before it.
    std::uint64_t dropped_time_out_of_range = 0;  ///< Below 0, or 2^53 µs and beyond.
    std::uint64_t poses_emitted = 0;
    std::uint64_t poses_thinned = 0;  ///< Left out to keep max_poses_per_s.
    /// How often an object was told to be lost, by LossCause; what changes while it is lost counts
    /// again.
    std::array<std::uint64_t, loss_causes> lost_by{};
};

}  // namespace pursuit::tracker
