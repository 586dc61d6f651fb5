// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pursuit {

/// Event times are below it: beyond, microseconds are no longer whole in a double; 285 years.
inline constexpr std::int64_t max_t_us = std::int64_t{1} << 53;

/// One brightness change at one pixel.
struct Event {
    /// Sensor time, µs, 0 … 2^53-1; unwrapped and never decreasing after the decoder.
    std::int64_t t_us;
    std::uint16_t x;        ///< Pixel, to the right, 0 … width-1.
    std::uint16_t y;        ///< Pixel, downwards, 0 … height-1.
    std::uint8_t polarity;  ///< 1 brighter (ON), 0 darker (OFF).

    friend bool operator==(const Event&, const Event&) = default;
};

/// The pixel array, px.
struct Geometry {
    std::uint16_t width = 0;
    std::uint16_t height = 0;

    friend bool operator==(const Geometry&, const Geometry&) = default;
};

}  // namespace pursuit
