// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "services/common/event.hpp"
#include "services/tracker/core/geometry/coast.hpp"

namespace pursuit::tracker {

/// Moves the events, in the order they came, to where an object that goes so would make them at
/// t_us; what would come from beyond the image, onto its border.
void lead_on(std::span<Event> events, std::int64_t t_us, const Coast& going, Geometry geometry);

}  // namespace pursuit::tracker
