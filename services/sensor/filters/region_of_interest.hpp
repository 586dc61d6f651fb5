// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "services/sensor/filters/filter.hpp"
#include "services/sensor/filters/filter_setting.hpp"

namespace pursuit::sensor {

inline constexpr std::array region_of_interest_parameters{
    FilterParameter{"x_px", 0, 65535, 0, true, "px", "the rectangle's left column"},
    FilterParameter{"y_px", 0, 32767, 0, true, "px", "its top row"},
    FilterParameter{"width_px", 1, 65536, 65536, true, "px", "its columns; beyond the image: all"},
    FilterParameter{"height_px", 1, 32768, 32768, true, "px", "its rows"},
    FilterParameter{"outside", 0, 1, 0, true, "", "1: keeps what is outside instead"},
};

/// Keeps the events of a rectangle of pixels, or those outside it. The image stays as large as it
/// is. Refuses a rectangle that begins outside the image.
Result<std::unique_ptr<Filter>> make_region_of_interest(const FilterArguments& arguments,
                                                        Geometry input);

}  // namespace pursuit::sensor
