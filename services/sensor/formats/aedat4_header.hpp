// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "services/common/event.hpp"
#include "services/common/result.hpp"
#include "services/sensor/formats/byte_source.hpp"

namespace pursuit::sensor {

/// What stands before the packets of an AEDAT 4 file.
struct Aedat4Header {
    enum class Compression { none, lz4, zstd };

    /// A stream of events: packets of other streams hold frames, motion samples, triggers.
    struct EventStream {
        std::int32_t id = 0;
        std::optional<Geometry> geometry;
    };

    Compression compression = Compression::none;
    std::int64_t packets_end = -1;     ///< Byte after the packets; -1: the end of the file.
    std::vector<EventStream> streams;  ///< By rising id; one at least.
    std::set<std::int32_t> described;  ///< The ids of all streams, those without events too.
};

constexpr std::string_view aedat4_magic = "#!AER-DAT4.0\r\n";

/// Reads the header and leaves `bytes` at the first packet. An error names byte and cause.
Result<Aedat4Header> read_aedat4_header(ByteWindow& bytes);

}  // namespace pursuit::sensor
