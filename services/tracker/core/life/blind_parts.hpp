// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "services/tracker/core/geometry/outline.hpp"
#include "services/tracker/core/geometry/pose.hpp"
#include "services/tracker/core/pixels/recent_pixels.hpp"

namespace pursuit::tracker {

/// Notes which parts of an outline come over pixels that still are blind from another part of it:
/// the far side of an object that is so fast that its near side was there a moment ago. They make
/// no events, though they are there and move. To be called often: it goes by most of the last
/// looks. radius_px: of the object in the image.
void look_for_blind_parts(std::int64_t t_us, const Pose& pose, const Velocity& velocity,
                          double radius_px, const RecentPixels& pixels, Outline& outline);

}  // namespace pursuit::tracker
