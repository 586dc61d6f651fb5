// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "services/sensor/formats/formats.hpp"

namespace pursuit::sensor {

/// Event Stream 2 (github.com/neuromorphic-paris/event_stream), of DVS and of ATIS events. A header
/// of 20 bytes: "Event Stream", three bytes of version, one of type (1 DVS, 2 ATIS), 16 bits of
/// width and 16 of height. Then 5 bytes an event: one of its own, 16 bits of x, 16 of y.
///
///   DVS:  7 bits of time since the last event in us, 1 of polarity.
///         0xff adds 127 us, 0xfe is padding.
///   ATIS: 6 bits of time, 1 of polarity (or the number of the threshold), 1 that tells an exposure
///         measurement from an event. 0xfd, 0xfe, 0xff add 63, 126, 189 us, 0xfc is padding.
///
/// - y is stored upwards: y = height - 1 - y_file, with the height in force (the header's, or the
///   one that is asked for).
/// - Time begins at 0, and cannot go back.
Result<std::unique_ptr<EventReader>> open_es(ByteWindow bytes, const ReadOptions& options);

bool looks_like_es(std::string_view head);

}  // namespace pursuit::sensor
