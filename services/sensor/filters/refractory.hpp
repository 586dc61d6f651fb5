// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "services/sensor/filters/filter.hpp"
#include "services/sensor/filters/filter_setting.hpp"

namespace pursuit::sensor {

inline constexpr std::array refractory_parameters{
    FilterParameter{"period_us", 1, 1e9, 1000, true, "us", "how long a pixel is not heard again"},
    FilterParameter{"by_polarity", 0, 1, 0, true, "", "1: ON and OFF have a period each"},
};

/// Drops an event when less than period_us has gone by since the last event of its pixel that
/// passed (with by_polarity: of its pixel and polarity).
Result<std::unique_ptr<Filter>> make_refractory(const FilterArguments& arguments, Geometry input);

}  // namespace pursuit::sensor
