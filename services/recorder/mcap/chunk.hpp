// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "services/common/result.hpp"
#include "services/recorder/mcap/records.hpp"

namespace pursuit::recorder::mcap {

/// What a reader takes into memory at most. A file that asks for more is refused at that place, so
/// that neither an absurd length nor a chunk that decompresses without end can exhaust memory.
struct ReadLimits {
    std::uint64_t record_bytes = 256ULL << 20;        ///< One record, as it is in the file.
    std::uint64_t uncompressed_bytes = 256ULL << 20;  ///< One chunk.
    std::uint64_t definition_bytes = 64ULL << 20;     ///< All schemas, channels and metadata.
    std::uint64_t open_chunk_bytes = 512ULL << 20;    ///< TimeOrderedReader: overlapping chunks.
};

/// The schemas and channels of a file, as far as it was read.
class Definitions {
 public:
    explicit Definitions(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

    /// Takes the content of a Schema or Channel record; a repetition must be identical. The error
    /// says what is wrong.
    /// in_chunk: it is covered by the CRC of a chunk. Such a record replaces one from outside, and
    /// is an error all the same.
    Result<void> add(Opcode opcode, ByteSpan content, bool in_chunk);

    /// Null where there is none.
    const Schema* schema(std::uint16_t id) const;
    const Channel* channel(std::uint16_t id) const;

    const std::map<std::uint16_t, Schema>& schemas() const { return schemas_; }
    const std::map<std::uint16_t, Channel>& channels() const { return channels_; }

 private:
    template <class T>
    Result<void> put(std::map<std::uint16_t, T>& known, T added, const std::string& name,
                     std::size_t bytes, bool in_chunk);

    std::map<std::uint16_t, Schema> schemas_;
    std::map<std::uint16_t, Channel> channels_;
    std::set<std::string> from_chunks_;  ///< "schema 3", "channel 1".
    std::uint64_t max_bytes_;
    std::uint64_t bytes_ = 0;
};

/// A chunk in memory, uncompressed.
struct Chunk {
    ChunkHead head;  ///< Without `records`.
    std::uint64_t compressed_bytes = 0;
    Bytes records;
};

/// Decompresses the content of a Chunk record and checks size and CRC. The error says what is
/// wrong.
Result<void> decode_chunk(ByteSpan content, const ReadLimits& limits, Chunk& chunk);

/// What check_records() found.
struct CheckedRecords {
    std::set<std::uint16_t> channels;  ///< Those with messages in the chunk.
    std::vector<std::string> faults;   ///< Of definitions outside the chunk that it corrects.
};

/// Checks every record of a chunk and adds its schemas and channels to `definitions`: afterwards
/// each message in it is well formed and of a known channel. The error says what is wrong; then
/// none of its messages counts.
Result<CheckedRecords> check_records(ByteSpan records, Definitions& definitions);

}  // namespace pursuit::recorder::mcap
