// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "services/common/event.hpp"
#include "services/common/result.hpp"
#include "services/sensor/formats/byte_source.hpp"

namespace pursuit::sensor {

/// What stands before the words of a Prophesee RAW file: lines of text that begin with '%', up to
/// "% end" or to the first byte of something else. Streams may have none.
struct RawHeader {
    /// "2.0", "2.1" or "3.0", from "% evt 3.0" or "% format EVT3;height=720;width=1280".
    std::optional<std::string> evt;
    std::optional<Geometry> geometry;  ///< From "% geometry 1280x720" or "% format".
    bool halves_swapped = false;       ///< EVT2.1 of "% format EVT21;endianness=legacy".
};

/// Reads the header and leaves `bytes` at the first word. An error names byte and cause: a size
/// that is none, a header that does not end within 1000 lines of 4096 bytes.
Result<RawHeader> read_raw_header(ByteWindow& bytes);

}  // namespace pursuit::sensor
