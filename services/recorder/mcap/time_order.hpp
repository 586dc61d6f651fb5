// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/recorder/mcap/reader.hpp"

namespace pursuit::recorder::mcap {

/// Gives the messages of a file in order of their log time, those of equal time in order of the
/// file.
///
/// It takes the places and times of the chunks from the summary, or, where there is none, from one
/// pass over the file, and merges the chunks that overlap in time. Like Reader it gives all
/// messages of the chunks before the first damage and then says what is wrong.
///
/// Memory: the chunks that overlap at one time, within limits.open_chunk_bytes; more is an error. A
/// file with messages outside chunks cannot be merged and is refused. One thread.
class TimeOrderedReader {
 public:
    static Result<TimeOrderedReader> open(std::unique_ptr<Input> input, std::string file_name,
                                          ReadLimits limits = {});

    /// As Reader::next(), in order of log time. `data` is valid until the next call.
    Result<std::optional<MessageView>> next();

    /// All schemas and channels of the file, known from the start.
    const Definitions& definitions() const { return definitions_; }

 private:
    struct Entry {
        std::int64_t time_ns = 0;
        std::size_t offset = 0;  ///< In the chunk's records.
    };
    struct OpenChunk {
        std::uint64_t file_offset = 0;
        Bytes records;
        std::vector<Entry> entries;  ///< In order of time.
        std::size_t next = 0;
    };

    TimeOrderedReader(std::unique_ptr<Input> input, std::string file_name, ReadLimits limits);

    Result<void> find_chunks();
    Result<void> open_chunk(const ChunkPlace& place);
    std::list<OpenChunk>::iterator earliest();

    std::unique_ptr<Input> input_;
    std::string file_name_;
    ReadLimits limits_;
    Definitions definitions_;
    std::vector<ChunkPlace> places_;  ///< In order of start time.
    std::size_t next_place_ = 0;
    std::list<OpenChunk> open_;
    std::uint64_t open_bytes_ = 0;
    std::optional<Error> fault_;  ///< Of the file behind its last good chunk, or of next().
};

}  // namespace pursuit::recorder::mcap
