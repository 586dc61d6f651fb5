// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "config.pb.h"
#include "services/sensor/formats/event_reader.hpp"

namespace pursuit::sensor {

/// Opens what a configuration names: a recording, or a scene with its seed; within start_s and
/// end_s. Opening again begins again: that is how a loop is made. An error where not exactly one
/// of the two is named, the range is empty, or the source cannot be opened.
Result<std::unique_ptr<EventReader>> open_source(const disk::SensorConfig& config);

}  // namespace pursuit::sensor
