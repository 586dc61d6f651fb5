// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/aedat4_compression.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <string>

namespace pursuit::sensor {
namespace {

constexpr std::size_t fewest_bytes = 1 << 16;
constexpr int largest_zstd_window_log = 26;  // 64 MiB

struct Step {
    std::size_t taken = 0;
    std::size_t made = 0;
    bool at_end = false;
    std::string error;
};

/// Decompresses by steps into a buffer that doubles while it is full.
template <class Decompress>
Result<void> decompress(std::span<const std::uint8_t> frame, std::vector<std::uint8_t>& out,
                        std::size_t most, Decompress decompress_step) {
    out.resize(std::min(std::max(4 * frame.size(), fewest_bytes), most));
    std::size_t made = 0;
    for (;;) {
        const Step step = decompress_step(frame, std::span(out).subspan(made));
        if (!step.error.empty()) return fail("damaged: " + step.error);
        frame = frame.subspan(step.taken);
        made += step.made;
        if (step.at_end) break;
        if (made == out.size()) {
            if (made == most) return fail("more than " + std::to_string(most) + " bytes unpacked");
            out.resize(std::min(2 * made, most));
        } else if (step.taken == 0 && step.made == 0) {
            return fail("incomplete");
        }
    }
    out.resize(made);
    return {};
}

}  // namespace

Result<void> decompress_lz4(std::span<const std::uint8_t> frame, std::vector<std::uint8_t>& out,
                            std::size_t most) {
    LZ4F_dctx* raw = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) {
        return fail("no memory to unpack");
    }
    const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> context(
        raw, LZ4F_freeDecompressionContext);
    return decompress(frame, out, most,
                      [&](std::span<const std::uint8_t> in, std::span<std::uint8_t> to) {
                          Step step{in.size(), to.size(), false, {}};
                          const auto left = LZ4F_decompress(context.get(), to.data(), &step.made,
                                                            in.data(), &step.taken, nullptr);
                          if (LZ4F_isError(left) != 0) step.error = LZ4F_getErrorName(left);
                          step.at_end = left == 0;
                          return step;
                      });
}

Result<void> decompress_zstd(std::span<const std::uint8_t> frame, std::vector<std::uint8_t>& out,
                             std::size_t most) {
    const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context(ZSTD_createDCtx(),
                                                                          ZSTD_freeDCtx);
    if (!context) return fail("no memory to unpack");
    ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, largest_zstd_window_log);
    return decompress(frame, out, most,
                      [&](std::span<const std::uint8_t> in, std::span<std::uint8_t> to) {
                          ZSTD_inBuffer from{in.data(), in.size(), 0};
                          ZSTD_outBuffer into{to.data(), to.size(), 0};
                          const auto left = ZSTD_decompressStream(context.get(), &into, &from);
                          Step step{from.pos, into.pos, left == 0, {}};
                          if (ZSTD_isError(left) != 0) step.error = ZSTD_getErrorName(left);
                          return step;
                      });
}

}  // namespace pursuit::sensor
