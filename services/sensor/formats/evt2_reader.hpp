// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "services/sensor/formats/byte_source.hpp"
#include "services/sensor/formats/event_reader.hpp"
#include "services/sensor/formats/raw_settings.hpp"

namespace pursuit::sensor {

/// EVT2: words of 32 bits, little-endian; bits 31..28 are its kind:
///   0, 1  an event, OFF or ON: bits 27..22 time, 21..11 x, 10..0 y;
///   8     TIME_HIGH: bits 27..0; time in us is TIME_HIGH * 64 + the event's.
/// `bytes` is at the first word.
std::unique_ptr<EventReader> make_evt2_reader(ByteWindow bytes, const RawSettings& settings);

}  // namespace pursuit::sensor
