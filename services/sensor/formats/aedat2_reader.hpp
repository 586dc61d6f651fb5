// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "services/sensor/formats/formats.hpp"

namespace pursuit::sensor {

/// AEDAT 2.0, of jAER: lines that begin with '#', then 8 bytes an event, the highest first: 32 bits
/// of address and 32 of time in us. The header's "# AEChip:" tells the camera, DVS128 where it does
/// not:
///   DVS128:              bit 0 polarity (0 ON), 7..1 x, 14..8 y; bit 15 is no event;
///   DAVIS240, DAVIS346:  bit 11 polarity (1 ON), 21..12 x, 30..22 y; bits 31 (frame or motion
///                        sample) and 10 (external input) are no events.
///
/// - x is stored mirrored: x = width - 1 - x_file. y is taken as stored.
/// - Time is unsigned and wraps at 2^32 us: it is unwrapped where it falls by more than half of
///   that. A rise by more than that after a wrap is what is late across it, and goes back.
Result<std::unique_ptr<EventReader>> open_aedat2(ByteWindow bytes, const ReadOptions& options);

bool looks_like_aedat2(std::string_view head);

}  // namespace pursuit::sensor
