// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "services/sensor/filters/filter.hpp"
#include "services/sensor/filters/filter_setting.hpp"

namespace pursuit::sensor {

inline constexpr std::array background_activity_parameters{
    FilterParameter{"window_us", 1, 1e9, 5000, true, "us",
                    "how recent a neighbour's event must be"},
    FilterParameter{"radius_px", 1, 3, 1, true, "px", "of the square neighbourhood"},
    FilterParameter{"support", 1, 48, 1, true, "pixels", "how many neighbours it takes"},
    FilterParameter{"same_polarity", 0, 1, 0, true, "", "1: only events of its polarity count"},
};

/// Drops an event unless at least `support` of the pixels around it, at most radius_px away in x
/// and in y and not itself, had an event within the last window_us. Dropped events support others
/// all the same: it is the sensor's activity that counts. Refuses more support than the
/// neighbourhood has pixels.
Result<std::unique_ptr<Filter>> make_background_activity(const FilterArguments& arguments,
                                                         Geometry input);

}  // namespace pursuit::sensor
