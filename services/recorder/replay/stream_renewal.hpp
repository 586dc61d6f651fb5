// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>

#include "services/recorder/packet_fields.hpp"
#include "services/recorder/replay/replay_pace.hpp"

namespace pursuit::recorder {

/// Makes the packets of a recording those of new streams. A packet's payload stays as it was but
/// for three fields: stream_id is another at each start, because it is a new stream; host_time_ns
/// is when the packet would be made now, and recorded_host_time_ns what it was. Threads: one.
class StreamRenewal {
 public:
    /// The new streams have this id and those after it, in the order in which they come.
    explicit StreamRenewal(std::uint64_t first_stream_id = 0) : next_stream_id_(first_stream_id) {}

    /// `payload` is a copy of what `packet` was made of; the packet was recorded at `log_time_ns`
    /// and is due at `due`.
    void renew(std::span<std::uint8_t> payload, const PacketFields& packet,
               std::int64_t log_time_ns, const ReplayPace::Due& due);

 private:
    std::map<std::uint64_t, std::uint64_t> new_stream_ids_;  ///< By the recorded ones.
    std::uint64_t next_stream_id_;
};

}  // namespace pursuit::recorder
