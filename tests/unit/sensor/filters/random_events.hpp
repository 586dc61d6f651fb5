// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "services/common/event.hpp"

namespace pursuit::sensor {

inline constexpr Geometry small{24, 18};

/// `count` events at random pixels, in order of time, steps of 0 to 2·mean_step_us; with bursts on
/// single pixels, so that neighbours and repeats are common.
inline std::vector<Event> random_events(std::size_t count, Geometry geometry, unsigned seed,
                                        int mean_step_us = 20) {
    std::mt19937 random(seed);
    const auto below = [&](unsigned n) { return static_cast<std::uint16_t>(random() % n); };
    std::vector<Event> events;
    std::int64_t t_us = below(1000);
    Event last{};
    for (std::size_t i = 0; i < count; ++i) {
        t_us += below(static_cast<unsigned>(2 * mean_step_us + 1));
        Event event{t_us, below(geometry.width), below(geometry.height),
                    static_cast<std::uint8_t>(below(2))};
        if (i > 0 && below(3) == 0) {
            event.x = last.x;
            event.y = last.y;
        }
        events.push_back(event);
        last = event;
    }
    return events;
}

}  // namespace pursuit::sensor
