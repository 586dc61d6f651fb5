// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "services/common/event.hpp"

namespace pursuit::sensor {

/// Consecutive events as they go into one packet; without events it says that none happened before
/// base_time_us.
struct EventBatch {
    std::int64_t base_time_us = 0;
    std::int64_t complete_us = 0;      ///< Sensor time at which the batch is known to be complete.
    bool end_of_stream = false;        ///< The last of its stream; empty.
    std::vector<std::uint64_t> words;  ///< packed_event.hpp

    friend bool operator==(const EventBatch&, const EventBatch&) = default;
};

/// Cuts a stream of events into batches.
///
/// A batch begins with its first event and is closed by `packet_events` events or by the end of
/// its `packet_us`, whichever comes first. While nothing happens an empty batch follows every
/// 20 ms of event time, counted from the last event, so that event time never stops. The stream
/// ends with an empty batch at last t_us + 1.
///
/// A stream that is cut short ends in order too: cut(), finish(), next() until null.
///
/// Pull: push() a span of events and advance() to the time reached, then next() until it returns
/// null, again and again; finish() once, then next() until null. One batch is held at a time,
/// whatever gaps the times have. One thread.
class Packetizer {
 public:
    struct Limits {
        std::uint32_t packet_events = 4096;  ///< 1 … 8000
        std::uint32_t packet_us = 1000;      ///< 1 … 20000
    };

    static constexpr std::int64_t silence_us = 20'000;

    explicit Packetizer(Limits limits);

    /// Gives the next events, in order of time. They are not copied: they must stay until next()
    /// has returned null.
    void push(std::span<const Event> events) { events_ = events; }

    /// Event time has reached t_us: no event that follows those pushed is earlier. Without it time
    /// is that of the last event pushed.
    void advance(std::int64_t t_us) { reached_us_ = std::max(reached_us_, t_us); }

    /// Closes the batch that is being filled, once what was pushed is in it.
    void flush() { flushing_ = true; }

    /// Leaves out what was pushed and is in no batch yet, and the time told beyond it: the stream
    /// is cut short. Returns how many events that are.
    std::size_t cut() {
        reached_us_ = -1;
        return std::exchange(events_, {}).size();
    }

    /// No event follows.
    void finish() { finished_ = true; }

    /// The next batch that is complete, valid until the following call; its words may be swapped
    /// for others, whose content is not used, to spare a copy. Null when more events are needed, or
    /// at the end.
    EventBatch* next();

 private:
    EventBatch* close(std::int64_t complete_us);
    EventBatch* empty(std::int64_t base_time_us);

    Limits limits_;
    std::span<const Event> events_;
    std::int64_t reached_us_ = -1;  // none yet
    bool flushing_ = false;
    bool finished_ = false;
    bool ended_ = false;
    bool open_ = false;  // batch_ is being filled
    EventBatch batch_;
    std::optional<std::int64_t> known_us_;  // event time has been told up to here
    std::int64_t last_t_us_ = 0;
};

}  // namespace pursuit::sensor
