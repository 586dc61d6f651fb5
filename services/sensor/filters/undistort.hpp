// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "services/sensor/filters/filter.hpp"
#include "services/sensor/filters/filter_setting.hpp"

namespace pursuit::sensor {

/// Moves each event to the pixel where a camera without distortion would have seen it, by a table
/// made once from a calibration file (Calibration of idl/filters.proto). Events that belong outside
/// the undistorted image are dropped. Pixels are rounded to the nearest: where the image is
/// stretched some pixels stay empty. Refuses a calibration of another size of image.
Result<std::unique_ptr<Filter>> make_undistort(const FilterArguments& arguments, Geometry input);

}  // namespace pursuit::sensor
