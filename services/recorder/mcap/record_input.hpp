// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "services/common/result.hpp"
#include "services/recorder/mcap/fault.hpp"
#include "services/recorder/mcap/input.hpp"
#include "services/recorder/mcap/records.hpp"

namespace pursuit::recorder::mcap {

/// The first bytes of a record: what it is, and how long.
struct RecordHead {
    Opcode opcode{};
    std::uint64_t size = 0;  ///< Bytes of the content; the file has them.
    std::array<std::uint8_t, record_head_bytes> bytes{};  ///< As they are in the file.
    std::uint32_t crc_before = 0;  ///< Of the file before it, or since restart_crc().
};

/// Reads an MCAP file as what frames it: magic, records of a stated length, magic. What is in the
/// records it does not look into. A fault ends the file: nothing may be read after it.
///
/// Memory: the content of one record, at most `record_bytes`. Threads: one.
class RecordInput {
 public:
    template <class T>
    using Read = tl::expected<T, Fault>;

    /// `size` is the input's size. The input must outlive this object.
    RecordInput(Input& input, std::uint64_t size, std::uint64_t record_bytes)
        : in_(input, size), record_bytes_(record_bytes) {}

    /// Reads the magic and the Header record at the file's start; gives the latter's content.
    Read<ByteSpan> read_header();

    /// Reads the next record's head. Then comes one of read_content(), skip() and
    /// check_trailing_crc(), with the size that it says.
    Read<RecordHead> read_head();

    /// What is given is valid until the next call of this object.
    Read<ByteSpan> read_content(std::uint64_t size);
    Read<void> skip(std::uint64_t size);

    /// Passes over content of at least 4 bytes, the last 4 of which are the CRC of the others or 0.
    /// Whether they are.
    Read<bool> check_trailing_crc(std::uint64_t size);

    /// Reads the magic at the file's end. A fault if more follows.
    Read<void> read_end();

    /// Of the record being read, bytes from the start of the file.
    std::uint64_t offset() const { return offset_; }
    /// Behind what was read.
    std::uint64_t position() const { return in_.position(); }
    void restart_crc() { in_.restart_crc(); }

 private:
    tl::unexpected<Fault> fault(Condition condition, std::string cause) const {
        return tl::unexpected(Fault{condition, offset_, std::move(cause)});
    }
    Read<void> read(std::span<std::uint8_t> into);

    SequentialInput in_;
    std::uint64_t record_bytes_;
    std::uint64_t offset_ = 0;
    Bytes content_;
};

}  // namespace pursuit::recorder::mcap
