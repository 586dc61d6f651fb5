// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <utility>

namespace pursuit::recorder {

/// Counts the breaks of the sequence numbers of event streams. A stream heard for the first time
/// has no break before it; at most 1024 streams are remembered. One thread.
class StreamGaps {
 public:
    /// True when packets are missing between the last one of this stream and this one.
    bool take(std::size_t topic, std::uint64_t stream_id, std::uint64_t sequence_number) {
        const auto [place, first] = last_.try_emplace(std::pair{topic, stream_id}, sequence_number);
        if (first) {
            if (last_.size() > most_streams) {
                const bool oldest_is_this = last_.begin() == place;
                last_.erase(oldest_is_this ? std::next(place) : last_.begin());
            }
            return false;
        }
        const bool gap = sequence_number > place->second + 1;
        if (gap) {
            ++gaps_;
            missed_ += sequence_number - place->second - 1;
        }
        if (sequence_number > place->second) place->second = sequence_number;
        return gap;
    }

    std::uint64_t gaps() const { return gaps_; }
    std::uint64_t missed() const { return missed_; }  ///< Packets, in those gaps.

 private:
    static constexpr std::size_t most_streams = 1024;
    std::map<std::pair<std::size_t, std::uint64_t>, std::uint64_t> last_;
    std::uint64_t gaps_ = 0;
    std::uint64_t missed_ = 0;
};

}  // namespace pursuit::recorder
