// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "services/sensor/formats/formats.hpp"

namespace pursuit::sensor {

/// DAT: a header (dat_header.hpp), then 8 bytes an event, little-endian: 32 bits of time in us and
/// an address,
///   version 2:  bits 13..0 x, 27..14 y, 31..28 polarity;
///   version 1:  bits 8..0 x, 16..9 y, 17 polarity, the rest unused.
/// y is stored downwards.
///
/// - A file that states no version is taken as version 1 when none of the first events sets a bit
///   above 17, which version 2 does with every ON event and every y above 15.
/// - A file that states no geometry is taken as ATIS, 304x240.
/// - Time wraps at 2^32 us: it is unwrapped where it falls by more than half of that; a rise
///   by more than that after a wrap is what is late across it, and goes back. A step back is an
///   error: everything downstream relies on the order of events, and a clamped time would be a
///   wrong one.
/// - A header without events is an empty recording, no error.
Result<std::unique_ptr<EventReader>> open_dat(ByteWindow bytes, const ReadOptions& options);

bool looks_like_dat(std::string_view head);

}  // namespace pursuit::sensor
