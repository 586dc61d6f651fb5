// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "services/sensor/formats/byte_source.hpp"
#include "services/sensor/formats/event_reader.hpp"
#include "services/sensor/formats/raw_settings.hpp"

namespace pursuit::sensor {

/// EVT2.1: words of 64 bits, little-endian; bits 63..60 are its kind:
///   0, 1  up to 32 events, OFF or ON: bits 59..54 time, 53..43 x, 42..32 y, 31..0 which of the
///         pixels x … x+31 there are events at, lowest bit first;
///   8     TIME_HIGH: bits 59..32; time in us is TIME_HIGH * 64 + the event's.
/// halves_swapped: as written by cameras of "endianness=legacy", each word's upper half first.
/// `bytes` is at the first word.
std::unique_ptr<EventReader> make_evt21_reader(ByteWindow bytes, const RawSettings& settings,
                                               bool halves_swapped);

}  // namespace pursuit::sensor
