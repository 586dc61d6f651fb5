// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/common/result.hpp"
#include "services/recorder/mcap/chunk.hpp"
#include "services/recorder/mcap/input.hpp"

namespace pursuit::recorder::mcap {

/// How a file ends.
enum class Condition {
    reading,     ///< Not at its end yet.
    closed,      ///< By its writer; every CRC is right.
    not_closed,  ///< After a whole record, without a summary: the writer was killed or still
                 ///< writes.
    cut,         ///< Inside a record: the writer was killed while it wrote, or the file was cut.
    damaged,     ///< A place says what it cannot say, or a CRC is wrong.
    unreadable,  ///< The disk gave an error.
};

/// "closed cleanly", "damaged", ….
std::string_view name_of(Condition condition);

/// What was found wrong, and where.
struct Fault {
    Condition condition = Condition::damaged;
    std::uint64_t offset = 0;  ///< Of the record, bytes from the start of the file.
    std::string cause;
};

/// "run.mcap: byte 4711: the chunk's CRC is …".
std::string to_string(const Fault& fault, const std::string& file_name);

/// A message in the reader's memory: `data` and `channel` are valid until the next call of next().
struct MessageView {
    MessageHead head;
    const Channel* channel = nullptr;
    ByteSpan data;
};

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

enum class OnDamage {
    stop,        ///< The first fault ends the reading.
    skip_chunk,  ///< A chunk that is damaged inside is left out, reading goes on after it.
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

    Condition condition() const { return condition_; }

    /// In order of the file; the first 100.
    const std::vector<Fault>& faults() const { return faults_; }

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

    void read_magic_and_header();
    std::optional<MessageView> take_from_chunk();
    std::optional<MessageView> read_record();
    bool load(std::uint64_t size);
    void read_chunk();
    void read_definition(Opcode opcode);
    void read_metadata();
    void read_message_index();
    std::optional<MessageView> read_message();
    void read_attachment(std::uint64_t size);
    void read_data_end();
    void read_footer(std::uint32_t crc);
    void end(Condition condition, std::string cause);
    void note(Condition condition, std::string cause);

    std::unique_ptr<Input> input_;
    SequentialInput in_;
    std::string file_name_;
    ReadLimits limits_;
    OnDamage on_damage_;

    Condition condition_ = Condition::reading;
    std::vector<Fault> faults_;
    Header header_;
    Definitions definitions_;
    std::vector<Metadata> metadata_;
    std::uint64_t metadata_bytes_ = 0;
    ReaderTotals totals_;

    std::uint64_t record_offset_ = 0;      ///< Of the record being read.
    std::uint32_t crc_before_record_ = 0;  ///< Of the file before it, or of the summary.
    Bytes content_;
    Chunk chunk_;
    std::size_t chunk_offset_ = 0;  ///< Of the next record in chunk_.
    std::optional<ChunkPlace> place_;
    bool chunk_damaged_ = false;  ///< The last one; then its index says nothing.
    std::set<std::uint16_t>
        not_indexed_;  ///< Channels of the last chunk, less those seen after it.
    std::optional<std::uint64_t> summary_begin_;  ///< Once DataEnd was read.
};

}  // namespace pursuit::recorder::mcap
