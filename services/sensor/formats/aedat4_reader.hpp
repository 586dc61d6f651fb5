// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "services/sensor/formats/formats.hpp"

namespace pursuit::sensor {

/// AEDAT 4, of DV (docs.inivation.com, "AEDAT file formats"): a line of text, a header in
/// FlatBuffers (aedat4.fbs) that describes the streams in XML, then packets of one stream each: 32
/// bits of stream id, 32 of size, and a FlatBuffers table, as it is or as an LZ4 or a Zstandard
/// frame.
///
/// - Events are those of the event stream with the lowest id; those of further ones are counted as
///   skipped. Packets of other streams (frames, motion samples, triggers) are passed over.
/// - A packet is at most 64 MiB, packed or not.
/// - Times are us since 1970. Geometry is in the header.
/// - What a damaged packet holds is lost whole; the error names the byte where it begins.
Result<std::unique_ptr<EventReader>> open_aedat4(ByteWindow bytes, const ReadOptions& options);

bool looks_like_aedat4(std::string_view head);

}  // namespace pursuit::sensor
