// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "services/sensor/formats/formats.hpp"

namespace pursuit::sensor {

/// The text of the RPG event camera datasets: "t_s x y p" a line, separated by blanks; t in
/// seconds is read exactly and rounded to the nearest us. Empty lines and lines that begin with
/// '#' are passed over. The text states no geometry: DAVIS240, 240x180, unless told.
/// Errors name byte, line and cause.
Result<std::unique_ptr<EventReader>> open_rpg_text(ByteWindow bytes, const ReadOptions& options);

bool looks_like_rpg_text(std::string_view head);

}  // namespace pursuit::sensor
