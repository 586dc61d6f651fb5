// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "services/sensor/filters/filter.hpp"
#include "services/sensor/filters/filter_setting.hpp"

namespace pursuit::sensor {

inline constexpr std::array turn_parameters{
    FilterParameter{"transpose", 0, 1, 0, true, "", "1: exchanges x and y, first"},
    FilterParameter{"rotate_deg", 0, 270, 0, true, "deg", "0, 90, 180 or 270, clockwise, then"},
    FilterParameter{"flip_x", 0, 1, 0, true, "", "1: left becomes right, then"},
    FilterParameter{"flip_y", 0, 1, 0, true, "", "1: top becomes bottom, last"},
};

/// The filter `geometry`: transposes, rotates and flips the image, in this order; its width and
/// height change places where x and y do. Refuses other angles, and an image that would have more
/// than 32768 rows.
Result<std::unique_ptr<Filter>> make_turn(const FilterArguments& arguments, Geometry input);

}  // namespace pursuit::sensor
