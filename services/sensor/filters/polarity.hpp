// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "services/sensor/filters/filter.hpp"
#include "services/sensor/filters/filter_setting.hpp"

namespace pursuit::sensor {

inline constexpr std::array polarity_parameters{
    FilterParameter{"keep", 0, 2, 2, true, "", "0: OFF events, 1: ON events, 2: both"},
    FilterParameter{"invert", 0, 1, 0, true, "", "1: those kept then change ON for OFF"},
};

/// Keeps one polarity, or exchanges the two (for a sensor that is wired the other way round).
Result<std::unique_ptr<Filter>> make_polarity(const FilterArguments& arguments, Geometry input);

}  // namespace pursuit::sensor
