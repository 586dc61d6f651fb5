// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/common/result.hpp"
#include "services/recorder/mcap/chunk.hpp"
#include "services/recorder/mcap/chunk_messages.hpp"
#include "services/recorder/mcap/fault.hpp"
#include "services/recorder/mcap/input.hpp"
#include "services/recorder/mcap/message_view.hpp"
#include "services/recorder/mcap/record_input.hpp"

namespace pursuit::recorder::mcap {

/// Where a chunk lies in the file.
struct ChunkPlace {
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;  ///< Of the whole record.
    std::int64_t start_time_ns = 0;
    std::int64_t end_time_ns = 0;
};

/// What was read so far.
struct ReaderTotals {
    std::uint64_t messages = 0;
    std::uint64_t chunks = 0;
    std::uint64_t compressed_bytes = 0;    ///< Of the chunks' records, in the file.
    std::uint64_t uncompressed_bytes = 0;  ///< The same, uncompressed.
    std::uint64_t damaged_chunks = 0;      ///< Left out, with OnDamage::skip_chunk.
};

/// Reads an MCAP file front to back, in one pass, without its summary; checks both magics, every
/// CRC and every length. A chunk's messages are given only after the whole chunk has been checked.
/// Works on files of any writer, with and without chunks; records it does not know are passed over.
///
/// Memory: one record and one uncompressed chunk, within `limits`. One thread.
class Reader {
 public:
    /// Reads the magic and the Header. file_name is what errors call the file.
    static Result<Reader> open(std::unique_ptr<Input> input, std::string file_name,
                               ReadLimits limits = {}, OnDamage on_damage = OnDamage::stop);

    /// The next message in the order of the file; nothing after the last of a file that is sound to
    /// its end. Otherwise, after the last message that could be read, the first fault as an error;
    /// condition() and faults() say more. Every message before it is good.
    Result<std::optional<MessageView>> next();

    Condition condition() const { return log_.condition(); }

    /// In order of the file; the first 100.
    const std::vector<Fault>& faults() const { return log_.faults(); }

    const Header& header() const { return header_; }

    /// Of what was read so far. All are known before their first message.
    const Definitions& definitions() const { return definitions_; }
    const std::vector<Metadata>& metadata() const { return metadata_; }
    const ReaderTotals& totals() const { return totals_; }

    /// The chunk of the last message; nothing for a message outside chunks.
    const std::optional<ChunkPlace>& chunk() const { return place_; }

 private:
    Reader(std::unique_ptr<Input> input, std::uint64_t size, std::string file_name,
           ReadLimits limits, OnDamage on_damage);

    void read_header();
    std::optional<MessageView> read_record();
    void read_chunk(ByteSpan content);
    void read_definition(Opcode opcode, ByteSpan content);
    void read_metadata(ByteSpan content);
    void read_message_index(ByteSpan content);
    std::optional<MessageView> read_message(ByteSpan content);
    void read_attachment(std::uint64_t size);
    void read_data_end(ByteSpan content, std::uint32_t crc);
    void read_footer(const RecordHead& head);
    void end(std::string cause);
    void damage(std::string cause);

    std::unique_ptr<Input> input_;
    RecordInput records_;
    std::string file_name_;
    ReadLimits limits_;

    FaultLog log_;
    Header header_;
    Definitions definitions_;
    std::vector<Metadata> metadata_;
    std::uint64_t metadata_bytes_ = 0;
    ReaderTotals totals_;

    ChunkMessages chunk_;
    std::optional<ChunkPlace> place_;
    std::optional<std::uint64_t> summary_begin_;  ///< Once DataEnd was read.
};

}  // namespace pursuit::recorder::mcap
