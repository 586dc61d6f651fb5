// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "services/common/result.hpp"
#include "services/recorder/mcap/bytes.hpp"

namespace pursuit::recorder::mcap {

enum class Compression { none, zstd };

/// As the specification's registry spells it: "" and "zstd".
std::string_view name_of(Compression compression);

/// CRC-32 as in zlib, continued from `crc` (0 at the start).
std::uint32_t crc32(std::uint32_t crc, ByteSpan data);

/// Compresses with libzstd; keeps its working memory from one call to the next.
class ZstdCompressor {
 public:
    /// `level` as libzstd takes it; 1 is fast.
    explicit ZstdCompressor(int level);
    ~ZstdCompressor();
    ZstdCompressor(ZstdCompressor&&) noexcept;
    ZstdCompressor& operator=(ZstdCompressor&&) noexcept;

    /// Replaces `out` by the compressed `data`.
    Result<void> compress(ByteSpan data, Bytes& out);

 private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Decompresses into exactly `out.size()` bytes; anything else than that many is an error.
Result<void> zstd_decompress(ByteSpan data, std::span<std::uint8_t> out);

}  // namespace pursuit::recorder::mcap
