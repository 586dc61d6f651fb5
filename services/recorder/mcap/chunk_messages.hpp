// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/common/result.hpp"
#include "services/recorder/mcap/chunk.hpp"
#include "services/recorder/mcap/message_view.hpp"

namespace pursuit::recorder::mcap {

/// The last chunk of a file that is read front to back: its messages, and the indexes that are to
/// follow it. Threads: one.
///
///   load() ─► next() gives each message ─► take_index() for each channel
///      └────► damaged: no messages, and what follows it is not judged
class ChunkMessages {
 public:
    /// Takes the content of a Chunk record, all of which is checked before any message is given.
    /// Returns what was wrong with definitions outside the chunk that it corrects. The error says
    /// why the chunk is damaged.
    Result<std::vector<std::string>> load(ByteSpan content, const ReadLimits& limits,
                                          Definitions& definitions);

    /// It is damaged after all.
    void discard();

    /// The next message; nothing after the last. `definitions` as load() left them.
    std::optional<MessageView> next(const Definitions& definitions);

    /// Whether an index with `bytes` of entries for this channel may follow the chunk; it has one
    /// for each of its channels.
    bool take_index(std::uint16_t channel_id, std::uint32_t bytes);

    /// Some of its channels' indexes have not come.
    bool awaits_index() const { return !not_indexed_.empty(); }

    /// Of the last load().
    const Chunk& chunk() const { return chunk_; }

 private:
    Chunk chunk_;
    std::size_t offset_ = 0;  ///< Of the next record in the chunk.
    bool damaged_ = false;
    std::set<std::uint16_t> not_indexed_;  ///< Channels of the chunk, less those indexed after it.
};

}  // namespace pursuit::recorder::mcap
