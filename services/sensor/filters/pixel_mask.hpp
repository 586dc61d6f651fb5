// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "services/sensor/filters/filter.hpp"
#include "services/sensor/filters/filter_setting.hpp"

namespace pursuit::sensor {

/// Drops the events of pixels listed in a file, a PixelMask of idl/filters.proto. Refuses a file
/// for another size of image, and pixels or rectangles that reach beyond it.
Result<std::unique_ptr<Filter>> make_pixel_mask(const FilterArguments& arguments, Geometry input);

}  // namespace pursuit::sensor
