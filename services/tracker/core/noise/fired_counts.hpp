// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pursuit::tracker {

/// How many events each pixel of a square window of the image made, OFF and ON.
struct FiredCounts {
    int left = 0;
    int top = 0;
    unsigned side = 0;  ///< px; 0: there is none yet.
    std::vector<std::array<std::uint16_t, 2>> events;

    void see(std::uint16_t x, std::uint16_t y, std::uint8_t polarity) {
        if (std::uint16_t* const count = count_of(x, y, polarity)) ++*count;
    }
    /// One that was seen is not to be counted.
    void forget(std::uint16_t x, std::uint16_t y, std::uint8_t polarity) {
        std::uint16_t* const count = count_of(x, y, polarity);
        if (count != nullptr && *count > 0) --*count;
    }
    /// Null where the pixel is not in the window.
    [[nodiscard]] std::uint16_t* count_of(std::uint16_t x, std::uint16_t y, std::uint8_t polarity) {
        const auto column = static_cast<unsigned>(x - left);
        const auto row = static_cast<unsigned>(y - top);
        if (column >= side || row >= side) return nullptr;
        return &events[row * side + column][polarity & 1];
    }
    void clear() { std::fill(events.begin(), events.end(), std::array<std::uint16_t, 2>{}); }
};

}  // namespace pursuit::tracker
