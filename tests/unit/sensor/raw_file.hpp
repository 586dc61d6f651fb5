// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/sensor/formats/formats.hpp"
#include "tests/unit/sensor/read_all.hpp"

/// Prophesee RAW files in memory.
namespace pursuit::sensor {

/// Words of 16 bits as they are in a file.
inline std::string bytes_of(const std::vector<std::uint16_t>& words) {
    std::string bytes;
    for (const auto word : words) bytes += little_endian(word);
    return bytes;
}

/// What a RAW file of these bytes holds, read `at_a_time` events at a time.
inline ReadAll decode_raw(const std::string& bytes, const ReadOptions& options = {},
                          std::size_t at_a_time = 1000) {
    return decode_bytes("a.raw", bytes, options, at_a_time);
}

}  // namespace pursuit::sensor
