// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "config.pb.h"
#include "services/sensor/formats/event_reader.hpp"
#include "services/sensor/formats/formats.hpp"
#include "services/sensor/live/live_input.hpp"

namespace pursuit::sensor {

/// What a configuration names, for people.
std::string source_name(const disk::SensorConfig& config);

/// Whether a configuration names a live source. An error where not exactly one source is named, or
/// a live one with what only the others have: loop, start_s, end_s.
Result<bool> is_live(const disk::SensorConfig& config);

/// How the bytes of a live source are read: live_format and live_geometry. Beside another source
/// they say nothing, and have to be good all the same.
Result<ReadOptions> live_options(const disk::SensorConfig& config);

/// Makes what hears the live source that a configuration names; an error where its address, format
/// or driver are not good. Nothing is connected yet.
Result<std::unique_ptr<LiveInput>> open_live(const disk::SensorConfig& config);

/// Opens what a configuration names: a recording, or a scene with its seed; within start_s and
/// end_s. Opening again begins again: that is how a loop is made. An error where neither of the two
/// is the one source named, the range is empty, or the source cannot be opened.
Result<std::unique_ptr<EventReader>> open_source(const disk::SensorConfig& config);

}  // namespace pursuit::sensor
