// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "services/common/event.hpp"
#include "services/common/result.hpp"
#include "services/sensor/formats/byte_source.hpp"

namespace pursuit::sensor {

/// What stands before the events of a DAT file: lines that begin with '%', then one byte for the
/// type of the events and one for their size. Old files have neither.
struct DatHeader {
    std::optional<int> version;        ///< "% Version N": 1 or 2.
    std::optional<Geometry> geometry;  ///< "% Width N" and "% Height N".
};

/// Reads the header and leaves `bytes` at the first event. An error names byte and cause: a line
/// that does not end, a number that is none, a version or event type that is not known.
Result<DatHeader> read_dat_header(ByteWindow& bytes);

}  // namespace pursuit::sensor
