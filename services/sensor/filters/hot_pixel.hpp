// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "services/sensor/filters/filter.hpp"
#include "services/sensor/filters/filter_setting.hpp"

namespace pursuit::sensor {

inline constexpr std::array hot_pixel_parameters{
    FilterParameter{"window_ms", 10, 60000, 1000, true, "ms", "events are counted over this"},
    FilterParameter{"rate_hz", 1, 1e6, 100, false, "1/s", "a hot pixel has at least this rate"},
    FilterParameter{"ratio", 1, 1e6, 10, false, "1",
                    "and at least this many times the mean of its 8 neighbours"},
};

/// Finds hot pixels and drops their events. Event time is cut into windows that begin with the
/// first event; a pixel is hot in a window when in the one before it fired at least rate_hz times a
/// second, and at least `ratio` times as often as the mean of its neighbours (those within the
/// image). So a pixel is masked one window after it became hot, and free again one window after it
/// has calmed down. After a window without events nothing is hot.
Result<std::unique_ptr<Filter>> make_hot_pixel(const FilterArguments& arguments, Geometry input);

}  // namespace pursuit::sensor
