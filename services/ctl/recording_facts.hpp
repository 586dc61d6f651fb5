// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/common/event.hpp"
#include "services/sensor/formats/event_reader.hpp"

namespace pursuit::ctl {

/// A silence that the sensor's status would call a fault.
inline constexpr std::int64_t silence_us = 100'000;

/// What there is to tell about a recording.
struct RecordingFacts {
    Geometry geometry;
    std::uint64_t events = 0;
    std::uint64_t on_events = 0;
    std::uint64_t exposures = 0;       ///< ATIS exposure measurements beside the events.
    std::uint64_t events_skipped = 0;  ///< EventReader::events_skipped().
    std::int64_t first_t_us = 0;
    std::int64_t last_t_us = 0;
    std::uint16_t x_min = 0, x_max = 0, y_min = 0, y_max = 0;
    std::int64_t longest_gap_us = 0;  ///< Without an event; begins at gap_t_us.
    std::int64_t gap_t_us = 0;
    std::uint64_t silences = 0;                 ///< Of silence_us or more without an event.
    std::vector<std::uint64_t> events_per_bin;  ///< From the first event on; 32 to 64 bins.
    std::int64_t bin_us = 1;
    std::string fault;  ///< What ended the reading before the end; empty for nothing.
};

RecordingFacts facts_of(sensor::EventReader& recording);

/// The event rate over time as one line of blocks of eight heights.
std::string rate_picture(const RecordingFacts& facts);

}  // namespace pursuit::ctl
