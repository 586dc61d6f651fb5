// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "services/tracker/core/pixels/recent_pixels.hpp"

namespace pursuit::tracker {

/// The most noise that there can be about a place, Hz a pixel. Noise comes from all pixels alike,
/// what moves from lines: of pixels spread evenly about the place, to extent_px and some px more,
/// it is told by how many have fired in the last over_us. (That of the lines is among them: there
/// may be less noise, and not more.) Infinite where too few of them lie in the image.
[[nodiscard]] double most_noise_hz(std::int64_t t_us, std::int64_t over_us,
                                   const Eigen::Vector2d& middle_px, double extent_px,
                                   const RecentPixels& pixels);

}  // namespace pursuit::tracker
