// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/summary.hpp"

#include <algorithm>

#include "services/recorder/mcap/compression.hpp"

namespace pursuit::recorder::mcap {
namespace {

constexpr std::size_t end_bytes = record_head_bytes + footer_bytes + magic.size();

Result<void> read_all(Input& input, std::uint64_t offset, std::span<std::uint8_t> into) {
    const auto n = input.read_at(offset, into);
    if (!n) return tl::unexpected(n.error());
    if (*n != into.size()) return fail("the file became shorter while it was read");
    return {};
}

}  // namespace

Result<Summary> read_summary(Input& input, const ReadLimits& limits) {
    const auto size = input.size();
    if (!size) return tl::unexpected(size.error());
    if (*size < magic.size() + end_bytes) return fail("the file is too short to have been closed");
    std::array<std::uint8_t, end_bytes> tail{};
    if (auto ok = read_all(input, *size - end_bytes, tail); !ok) return tl::unexpected(ok.error());
    if (!std::equal(magic.begin(), magic.end(), tail.end() - magic.size())) {
        return fail("the file was not closed");
    }
    std::size_t at = 0;
    const auto record = take_record(ByteSpan(tail).first(end_bytes - magic.size()), at);
    Footer footer;
    if (!record || record->opcode != Opcode::footer || !parse(record->content, footer)) {
        return fail("the file has no Footer record");
    }
    if (footer.summary_start == 0) return fail("the file has no summary");
    const std::uint64_t footer_offset = *size - end_bytes;
    if (footer.summary_start < magic.size() || footer.summary_start > footer_offset) {
        return fail("the Footer says that the summary begins at byte " +
                    std::to_string(footer.summary_start) + ", which it cannot");
    }
    const std::uint64_t bytes = footer_offset - footer.summary_start;
    if (bytes > limits.record_bytes) {
        return fail("a summary of " + std::to_string(bytes) + " bytes; at most " +
                    std::to_string(limits.record_bytes) + " are read");
    }

    Bytes records(static_cast<std::size_t>(bytes));
    if (auto ok = read_all(input, footer.summary_start, records); !ok) {
        return tl::unexpected(ok.error());
    }
    auto crc = crc32(0, records);
    crc = crc32(crc, ByteSpan(tail).first(record_head_bytes + footer_bytes - 4));
    if (footer.summary_crc != 0 && footer.summary_crc != crc) {
        return fail("the CRC of the summary is wrong");
    }

    Summary summary(limits);
    for (std::size_t offset = 0; offset < records.size();) {
        const auto each = take_record(records, offset);
        if (!each) return fail("a record of the summary does not fit into it");
        bool ok = true;
        if (each->opcode == Opcode::schema || each->opcode == Opcode::channel) {
            if (auto added = summary.definitions.add(each->opcode, each->content, false); !added) {
                return fail("in the summary: " + added.error().message);
            }
        } else if (each->opcode == Opcode::statistics) {
            ok = parse(each->content, summary.statistics.emplace());
        } else if (each->opcode == Opcode::chunk_index) {
            ok = parse(each->content, summary.chunks.emplace_back());
        }
        if (!ok) return fail("a malformed " + name_of(each->opcode) + " record in the summary");
    }
    return summary;
}

}  // namespace pursuit::recorder::mcap
