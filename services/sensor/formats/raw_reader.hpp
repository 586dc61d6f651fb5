// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "services/sensor/formats/formats.hpp"

namespace pursuit::sensor {

/// Prophesee RAW: a header (raw_header.hpp), then the words of EVT2, EVT2.1 or EVT3
/// (evt2_reader.hpp, evt21_reader.hpp, evt3_reader.hpp), as docs.prophesee.ai describes them under
/// "Data encoding formats". What holds for all three:
///
/// - Time comes in two parts, TIME_HIGH and the rest. An event before the first TIME_HIGH has none:
///   an error, unless the stream is joined late.
/// - TIME_HIGH wraps: time is unwrapped where it falls by more than half of its range.
///   A rise by more than that after a wrap is what is late across it, and goes back.
/// - External triggers and the words of other kinds (OTHERS, CONTINUED) are passed over; a word of
/// a
///   kind that the format does not define is an error.
/// - A file that states no geometry is taken as 640x480 (EVT2) or 1280x720 (EVT2.1, EVT3).
Result<std::unique_ptr<EventReader>> open_raw(ByteWindow bytes, const ReadOptions& options);

/// The same where the header may be missing, as in a live stream. A header of another format is an
/// error.
Result<std::unique_ptr<EventReader>> open_evt2(ByteWindow bytes, const ReadOptions& options);
Result<std::unique_ptr<EventReader>> open_evt21(ByteWindow bytes, const ReadOptions& options);
Result<std::unique_ptr<EventReader>> open_evt3(ByteWindow bytes, const ReadOptions& options);

bool looks_like_raw(std::string_view head);

}  // namespace pursuit::sensor
