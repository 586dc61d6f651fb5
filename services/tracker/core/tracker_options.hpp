// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "services/common/event.hpp"

namespace pursuit::tracker {

/// Images have so many pixels at most, as of 3840×2160: the tracker keeps 16 bytes for each.
inline constexpr std::size_t max_pixels = std::size_t{1} << 23;
constexpr bool is_usable(Geometry geometry) {
    const std::size_t pixels = std::size_t{geometry.width} * geometry.height;
    return pixels > 0 && pixels <= max_pixels;
}

/// What a tracker is made with.
struct TrackerOptions {
    double pose_rate_hz = 1000;       ///< The event-time grid, 1 … 100,000.
    double max_poses_per_s = 10'000;  ///< All objects together, 1 … 1e6; thinned evenly beyond.
    std::uint32_t max_objects = 256;  ///< 1 … 256.
    std::string preset = "default";   ///< The constants to begin with.
    bool emit_updates = false;        ///< Hand every step to PoseSink::update().
    /// Ids below it are never chosen (they were used before); no_object_id_left is one such.
    std::uint32_t next_object_id = 1;
    bool only_checks = false;  ///< Answers calls, and takes no stream.
    Geometry reserved = {};    ///< Memory for so large an image is there before the stream begins.
};

}  // namespace pursuit::tracker
