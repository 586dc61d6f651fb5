// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/compression.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>

namespace pursuit::recorder::mcap {

std::string_view name_of(Compression compression) {
    return compression == Compression::zstd ? "zstd" : "";
}

std::uint32_t crc32(std::uint32_t crc, ByteSpan data) {
    // crc32_z() gives the start value, not the CRC so far, for a null pointer.
    if (data.empty()) return crc;
    return static_cast<std::uint32_t>(::crc32_z(crc, data.data(), data.size()));
}

struct ZstdCompressor::State {
    ZSTD_CCtx* context = ZSTD_createCCtx();
    int level = 1;

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { ZSTD_freeCCtx(context); }
};

ZstdCompressor::ZstdCompressor(int level) : state_(std::make_unique<State>()) {
    state_->level = std::clamp(level, ZSTD_minCLevel(), ZSTD_maxCLevel());
}
ZstdCompressor::~ZstdCompressor() = default;
ZstdCompressor::ZstdCompressor(ZstdCompressor&&) noexcept = default;
ZstdCompressor& ZstdCompressor::operator=(ZstdCompressor&&) noexcept = default;

Result<void> ZstdCompressor::compress(ByteSpan data, Bytes& out) {
    if (state_->context == nullptr) return fail("zstd: no memory for a compressor");
    out.resize(ZSTD_compressBound(data.size()));
    const std::size_t n = ZSTD_compressCCtx(state_->context, out.data(), out.size(), data.data(),
                                            data.size(), state_->level);
    if (ZSTD_isError(n) != 0) return fail(std::string("zstd: ") + ZSTD_getErrorName(n));
    out.resize(n);
    return {};
}

Result<void> zstd_decompress(ByteSpan data, std::span<std::uint8_t> out) {
    const std::size_t n = ZSTD_decompress(out.data(), out.size(), data.data(), data.size());
    if (ZSTD_isError(n) != 0) {
        return fail(std::string("zstd cannot decompress it: ") + ZSTD_getErrorName(n));
    }
    if (n != out.size()) {
        return fail("it decompresses to " + std::to_string(n) + " bytes instead of the " +
                    std::to_string(out.size()) + " it declares");
    }
    return {};
}

}  // namespace pursuit::recorder::mcap
