// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "services/common/event.hpp"

namespace pursuit::sensor {

/// The exposure measurements of an ATIS (Posch et al. 2011): a change event starts one at its
/// pixel, which gives up one that still runs. A measurement is two crossings of a falling voltage,
/// the faster the brighter: threshold 0 a tenth of the way after its start, threshold 1 at its end.
///
///     idle --event--> waiting for 0 --crossing--> waiting for 1 --crossing--> idle
///
/// The time between the two is `whole_us` / brightness. Time runs forward at each pixel; take()
/// hands out what no later start can undo.
class Exposures {
 public:
    /// `whole_us`: how long a measurement of brightness 1 lasts, more than 0.
    Exposures(Geometry geometry, double whole_us);

    /// A change event at `t_us`, not before any other of this pixel; 0 < brightness ≤ 1.
    void start(std::uint32_t index, std::int64_t t_us, float brightness);

    /// Appends every crossing before `end_us` in order of time, then row, column; each once. No
    /// start() before `end_us` may follow.
    void take(std::int64_t end_us, std::vector<Event>& crossings);

 private:
    struct Measurement {
        std::int64_t first_us = 0;
        std::int64_t second_us = 0;
        std::uint8_t next = 0;  // the crossing that is waited for
        bool runs = false;
    };

    /// Moves the crossings of a pixel before `end_us` to those that are settled.
    void settle(std::uint32_t index, std::int64_t end_us);

    Geometry geometry_;
    double whole_us_;
    std::vector<Measurement> measurements_;  // by pixel
    std::vector<std::uint32_t> running_;     // pixels
    std::vector<Event> settled_;             // not yet handed out
};

}  // namespace pursuit::sensor
