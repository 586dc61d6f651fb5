// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "services/sensor/formats/formats.hpp"

namespace pursuit::sensor {

/// CSV: one event a line, whole numbers separated by commas: time in us, x, y (downwards),
/// polarity.
///
///   # geometry 304x240
///   t_us,x,y,p
///   12,303,7,1
///
/// - Lines that begin with '#' or '%' are remarks. One before the first event states the geometry:
///   "# geometry WxH" or "%geometry:W,H"; a file without must be told its geometry.
/// - A line of names may stand before the events, in any order and with columns of other names: t,
///   t_us, timestamp or timestamp_us; x; y; p or polarity. Without it: t_us,x,y,p.
Result<std::unique_ptr<EventReader>> open_csv(ByteWindow bytes, const ReadOptions& options);

bool looks_like_csv(std::string_view head);

}  // namespace pursuit::sensor
