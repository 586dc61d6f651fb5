// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "services/common/event.hpp"

namespace pursuit::tracker::test {

/// An upright edge that moves right by 1 px a ms, from x = 10 at `from_us` on: with c = 1000 px/s
/// its events lie in the plane x − 10 = c·(t − from), normal (1, 0, −1)/√2.
inline std::vector<Event> edge_events(std::int64_t from_us, int ms) {
    std::vector<Event> events;
    for (int k = 0; k <= ms; ++k) {
        for (int y = 20; y < 40; ++y) {
            events.push_back({from_us + k * 1000, static_cast<std::uint16_t>(10 + k),
                              static_cast<std::uint16_t>(y), 1});
        }
    }
    return events;
}

}  // namespace pursuit::tracker::test
