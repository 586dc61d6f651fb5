// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/common/result.hpp"

namespace pursuit::sensor {

/// Replaces `out` by what an LZ4 frame or a Zstandard frame holds. An error where it is damaged,
/// incomplete, or holds more than `most` bytes; `out` grows with what there is, never to more.
Result<void> decompress_lz4(std::span<const std::uint8_t> frame, std::vector<std::uint8_t>& out,
                            std::size_t most);
Result<void> decompress_zstd(std::span<const std::uint8_t> frame, std::vector<std::uint8_t>& out,
                             std::size_t most);

}  // namespace pursuit::sensor
