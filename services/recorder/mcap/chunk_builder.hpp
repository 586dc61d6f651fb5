// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "services/recorder/mcap/compression.hpp"
#include "services/recorder/mcap/records.hpp"

namespace pursuit::recorder::mcap {

/// The open chunk: schemas, channels and messages in memory, and the index of its messages.
class ChunkBuilder {
 public:
    void add(const Schema& schema) { append(records_, schema); }
    void add(const Channel& channel) { append(records_, channel); }
    void add(const MessageHead& head, ByteSpan data);

    bool empty() const { return records_.empty(); }

    /// Uncompressed bytes so far.
    std::size_t size() const { return records_.size(); }

    /// Appends to `out` the Chunk record and after it one MessageIndex record for each channel,
    /// and empties the chunk. `file_offset` is where `out` begins to be written from its present
    /// end. compressor: null for none. On an error nothing is appended and the chunk stays.
    Result<ChunkIndex> finish(ZstdCompressor* compressor, std::uint64_t file_offset, Bytes& out);

 private:
    using Entry = std::pair<std::int64_t, std::uint64_t>;  ///< Log time, offset in records_.

    Bytes records_;
    Bytes compressed_;
    std::map<std::uint16_t, std::vector<Entry>> index_;
    std::int64_t start_time_ns_ = 0;
    std::int64_t end_time_ns_ = 0;
};

}  // namespace pursuit::recorder::mcap
