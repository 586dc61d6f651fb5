// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "services/sensor/formats/event_writer.hpp"

namespace pursuit::sensor {

/// Writes Event Stream 2.0 (es_reader.hpp): of ATIS events where exposure measurements are to be
/// held, else of DVS events. Events and measurements of one time are written events first.
///
/// Time begins at 0 and is stored as steps, long ones as one byte every 127 us (ATIS: 189): a step
/// of 2^32 us (71 minutes) or more is refused, the first one as well.
Result<std::unique_ptr<EventWriter>> create_es(const std::string& path, Geometry geometry,
                                               bool exposures = false);

}  // namespace pursuit::sensor
