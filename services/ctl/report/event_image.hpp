// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "services/common/event.hpp"
#include "services/common/result.hpp"

namespace pursuit::ctl {

/// The events as a PNG of the size of the pixel array, transparent where nothing happened, in two
/// colours that read on light and on dark: the polarity that is more frequent at a pixel, stronger
/// the more events it has. Events outside the geometry are left out.
Result<std::vector<std::uint8_t>> event_png(const std::vector<Event>& events, Geometry geometry);

}  // namespace pursuit::ctl
