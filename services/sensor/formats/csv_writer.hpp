// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "services/sensor/formats/event_writer.hpp"

namespace pursuit::sensor {

/// Writes CSV (csv_reader.hpp) with its geometry and the names of its columns: any time, any
/// geometry. Exposure measurements are not held, whether they are asked for or not.
Result<std::unique_ptr<EventWriter>> create_csv(const std::string& path, Geometry geometry,
                                                bool exposures = false);

}  // namespace pursuit::sensor
