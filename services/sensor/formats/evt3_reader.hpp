// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "services/sensor/formats/byte_source.hpp"
#include "services/sensor/formats/event_reader.hpp"
#include "services/sensor/formats/raw_settings.hpp"

namespace pursuit::sensor {

/// EVT3: words of 16 bits, little-endian; bits 15..12 are its kind. Each sets a part of what the
/// next events have in common, or makes events of it:
///   0  ADDR_Y: bits 10..0 y;
///   2  ADDR_X: an event: bits 10..0 x, 11 polarity;
///   3  VECT_BASE_X: bits 10..0 x of the next vector, 11 its polarity;
///   4, 5  VECT_12, VECT_8: events at those of the 12 or 8 pixels from the base on whose bit is
///   set,
///      lowest first; the base moves on by 12 or 8;
///   6, 8  TIME_LOW, TIME_HIGH: 12 bits each; time in us is TIME_HIGH * 4096 + TIME_LOW.
///
/// Time follows TIME_HIGH: a TIME_LOW that steps back is no wrap. Where TIME_HIGH changes, TIME_LOW
/// begins at 0. `bytes` is at the first word.
std::unique_ptr<EventReader> make_evt3_reader(ByteWindow bytes, const RawSettings& settings);

}  // namespace pursuit::sensor
