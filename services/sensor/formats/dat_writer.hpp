// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "services/sensor/formats/event_writer.hpp"

namespace pursuit::sensor {

/// Writes DAT version 2 (dat_reader.hpp) with its geometry in the header.
///
/// Time is stored modulo 2^32 us. What a reader could not unwrap is refused: a first event at or
/// after 2^32 us (71 minutes), or 35 minutes without an event across a wrap. Geometry is at most
/// 16384x16384. Exposure measurements are not held, whether they are asked for or not. The file has
/// no date: the same events make the same file.
Result<std::unique_ptr<EventWriter>> create_dat(const std::string& path, Geometry geometry,
                                                bool exposures = false);

}  // namespace pursuit::sensor
