// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/record_input.hpp"

#include <algorithm>

#include "services/recorder/mcap/compression.hpp"

namespace pursuit::recorder::mcap {
namespace {

/// Of content that is only passed over.
constexpr std::size_t block_bytes = 64 << 10;

std::string bytes_text(std::uint64_t bytes) { return std::to_string(bytes) + " bytes"; }

}  // namespace

RecordInput::Read<void> RecordInput::read(std::span<std::uint8_t> into) {
    if (auto ok = in_.read(into); !ok) return fault(Condition::unreadable, ok.error().message);
    return {};
}

RecordInput::Read<ByteSpan> RecordInput::read_header() {
    std::array<std::uint8_t, magic.size()> found{};
    if (in_.remaining() == 0) return fault(Condition::cut, "the file is empty");
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(in_.remaining(), found.size()));
    if (auto ok = read(std::span(found).first(n)); !ok) return tl::unexpected(ok.error());
    if (!std::equal(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(n), magic.begin())) {
        return fault(Condition::damaged, "this is not an MCAP file: it does not begin as one");
    }
    if (n < found.size()) return fault(Condition::cut, "the file ends within its first bytes");

    offset_ = in_.position();
    if (in_.remaining() < record_head_bytes) {
        return fault(Condition::cut, "the file ends before its Header record");
    }
    std::array<std::uint8_t, record_head_bytes> head{};
    if (auto ok = read(head); !ok) return tl::unexpected(ok.error());
    ByteReader reader(head);
    const auto opcode = static_cast<Opcode>(reader.u8());
    if (opcode != Opcode::header) {
        return fault(Condition::damaged, "a Header record belongs here, not " + name_of(opcode));
    }
    return read_content(reader.u64());
}

RecordInput::Read<RecordHead> RecordInput::read_head() {
    offset_ = in_.position();
    if (in_.remaining() == 0) {
        return fault(Condition::not_closed,
                     "the file ends here without having been closed; all before is good");
    }
    if (in_.remaining() < record_head_bytes) {
        return fault(Condition::cut, "the file ends within the first " +
                                         bytes_text(record_head_bytes) + " of a record");
    }
    RecordHead head;
    head.crc_before = in_.crc();
    if (auto ok = read(head.bytes); !ok) return tl::unexpected(ok.error());
    ByteReader reader(head.bytes);
    head.opcode = static_cast<Opcode>(reader.u8());
    head.size = reader.u64();
    if (static_cast<std::uint8_t>(head.opcode) == 0) {
        return fault(Condition::damaged, "a record with opcode 0, which does not exist");
    }
    if (head.size > in_.remaining()) {
        return fault(Condition::cut, "the file ends within a " + name_of(head.opcode) +
                                         " record of " + bytes_text(head.size) + ", of which " +
                                         bytes_text(in_.remaining()) + " are there");
    }
    return head;
}

RecordInput::Read<ByteSpan> RecordInput::read_content(std::uint64_t size) {
    if (size > in_.remaining()) {
        return fault(Condition::cut, "the file ends within a record of " + bytes_text(size));
    }
    if (size > record_bytes_) {
        return fault(Condition::damaged, "a record of " + bytes_text(size) + "; at most " +
                                             std::to_string(record_bytes_) + " are read");
    }
    content_.resize(static_cast<std::size_t>(size));
    if (auto ok = read(content_); !ok) return tl::unexpected(ok.error());
    return content_;
}

RecordInput::Read<void> RecordInput::skip(std::uint64_t size) {
    if (auto ok = in_.skip(size); !ok) return fault(Condition::unreadable, ok.error().message);
    return {};
}

RecordInput::Read<bool> RecordInput::check_trailing_crc(std::uint64_t size) {
    std::uint32_t crc = 0;
    content_.resize(block_bytes);
    for (std::uint64_t left = size - 4; left > 0;) {
        const auto n = std::min<std::uint64_t>(left, content_.size());
        const auto block = std::span(content_).first(static_cast<std::size_t>(n));
        if (auto ok = read(block); !ok) return tl::unexpected(ok.error());
        crc = crc32(crc, block);
        left -= n;
    }
    std::array<std::uint8_t, 4> stored_bytes{};
    if (auto ok = read(stored_bytes); !ok) return tl::unexpected(ok.error());
    const auto stored = ByteReader(stored_bytes).u32();
    return stored == 0 || stored == crc;
}

RecordInput::Read<void> RecordInput::read_end() {
    offset_ = in_.position();
    std::array<std::uint8_t, magic.size()> found{};
    if (in_.remaining() < found.size()) {
        return fault(Condition::cut, "the file ends within its last bytes");
    }
    if (auto ok = read(found); !ok) return tl::unexpected(ok.error());
    if (found != magic) return fault(Condition::damaged, "the file does not end as an MCAP file");
    if (in_.remaining() != 0) {
        offset_ = in_.position();
        return fault(Condition::damaged, bytes_text(in_.remaining()) + " follow the file's end");
    }
    return {};
}

}  // namespace pursuit::recorder::mcap
