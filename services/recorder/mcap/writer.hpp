// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "services/common/result.hpp"
#include "services/recorder/mcap/chunk_builder.hpp"
#include "services/recorder/mcap/output.hpp"

namespace pursuit::recorder::mcap {

struct WriterOptions {
    Compression compression = Compression::zstd;
    int zstd_level = 1;  ///< Higher: smaller and slower.

    /// A chunk is closed by whichever comes first. Larger compresses better; what is in the open
    /// chunk is lost by a kill -9.
    std::size_t chunk_bytes = 1 << 20;
    std::int64_t chunk_age_us = 200'000;

    /// How long written chunks may wait for Output::flush(), by the clock of tick(). 0: every
    /// chunk is flushed as it is closed, so that a power cut loses no more than a kill -9 does.
    std::int64_t flush_interval_us = 0;

    std::size_t max_message_bytes = 64 << 20;     ///< A larger message is refused.
    std::size_t max_definition_bytes = 16 << 20;  ///< Schemas and channels; more are refused.

    /// Memory for the index of chunks in the summary, about 100 bytes a chunk. A file with more
    /// chunks is closed without that index: every message is there, but a reader that seeks must
    /// scan. 64 MiB last for more than a day of chunks of 200 ms.
    std::size_t max_index_bytes = 64 << 20;

    std::string profile;
    std::string library = "pursuit";
};

/// What has been written; for a status, and as the summary of the file.
struct WriterTotals {
    std::uint64_t bytes = 0;  ///< In the file; the open chunk is not counted.
    std::uint64_t flushed_bytes = 0;
    std::uint64_t open_chunk_bytes = 0;
    std::uint64_t chunks = 0;
    std::uint64_t messages = 0;  ///< Including those in the open chunk.
    std::uint64_t message_bytes = 0;
    std::map<std::uint16_t, std::uint64_t> channel_messages;
    std::uint32_t metadata = 0;
    std::int64_t start_time_ns = 0;  ///< Earliest log time; 0 without messages.
    std::int64_t end_time_ns = 0;
};

/// Writes one MCAP file.
///
///   create() ─► open ── add…, write, tick ──► open ── close() ─► closed
///                 └─ an output or compressor error ─► failed
///
/// Each chunk goes to the output in one write as soon as it is closed, so that after a kill -9 the
/// file holds every message but those of the open chunk. A schema and a channel are written twice
/// before the first message of the channel: on their own, so that a damaged chunk takes no other
/// with it, and in the chunk, where its CRC covers them. Nothing that a reader needs is written
/// only by close().
///
/// An error of a single call (an unknown channel, too large a message) changes nothing and the file
/// goes on. After an error of the output the file cannot go on: every later call gives that error
/// again; what was complete before stays readable. The destructor does not close the file.
///
/// Memory: the open chunk (chunk_bytes and one message) twice, 16 bytes a message in it, the
/// definitions and the chunk index as bounded in the options. One thread.
class Writer {
 public:
    /// Writes the beginning of the file. now_us: any steady clock, the same as for tick().
    static Result<Writer> create(std::unique_ptr<Output> output, WriterOptions options,
                                 std::int64_t now_us);

    /// The id of a schema; the same content gives the same id again.
    Result<std::uint16_t> add_schema(std::string_view name, std::string_view encoding,
                                     std::string_view data);

    /// The id of a channel; the same content gives the same id again. schema_id 0: no schema.
    Result<std::uint16_t> add_channel(std::uint16_t schema_id, std::string_view topic,
                                      std::string_view message_encoding, const StringMap& metadata);

    /// Facts about the whole file. Written at once, ahead of the open chunk.
    Result<void> add_metadata(const Metadata& metadata);

    /// Appends one message. log_time_ns: when it was received, ns since 1970, not negative.
    /// publish_time_ns: when it was sent; negative means not known, and the log time is written.
    /// data: as received, copied.
    Result<void> write(const MessageHead& head, ByteSpan data);

    /// Says what time it is: closes a chunk that is old enough and flushes when that is due. Call
    /// it at least every chunk_age_us / 4, also when nothing is written.
    Result<void> tick(std::int64_t now_us);

    /// Closes the open chunk now and flushes.
    Result<void> flush();

    /// Closes the open chunk, writes the summary and the end of the file, and flushes.
    Result<void> close();

    const WriterTotals& totals() const { return totals_; }

    /// Whether the chunk index has reached its bound; a recorder would begin a new file.
    bool index_full() const { return index_full_; }

 private:
    Writer(std::unique_ptr<Output> output, WriterOptions options, std::int64_t now_us);

    Result<void> usable() const;
    Result<void> put(ByteSpan data);
    Result<void> flush_output();
    Result<void> close_chunk();
    Result<void> define(const Bytes& record, const std::string& what);
    void append_summary(Bytes& out, std::uint64_t file_offset) const;

    std::unique_ptr<Output> output_;
    WriterOptions options_;
    std::optional<ZstdCompressor> compressor_;
    ChunkBuilder chunk_;
    std::int64_t now_us_;
    std::int64_t chunk_opened_us_ = 0;
    std::int64_t unflushed_since_us_ = 0;

    std::vector<Schema> schemas_;    ///< Id = position + 1.
    std::vector<Channel> channels_;  ///< Likewise.
    std::size_t definition_bytes_ = 0;
    Bytes chunk_indexes_;  ///< Records, as the summary will hold them.
    bool index_full_ = false;
    Bytes metadata_indexes_;

    WriterTotals totals_;
    std::uint32_t data_crc_ = 0;
    Bytes scratch_;
    std::optional<Error> failure_;
    bool closed_ = false;
};

}  // namespace pursuit::recorder::mcap
