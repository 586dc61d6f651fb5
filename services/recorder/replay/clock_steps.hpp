// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "services/recorder/packet_fields.hpp"

namespace pursuit::recorder {

/// Where somebody set the recording host's clock while it recorded. From there on `shift_ns` is
/// added to log times, so that the message is due with the one before it.
struct ClockStep {
    std::uint64_t message;  ///< The first after it, counted from 0 in the order of the file.
    std::int64_t shift_ns;
};

/// Finds those steps. Log times are CLOCK_REALTIME: a replay paced by them as they are would stand
/// still for as long as the clock was set forward, and hurry for as long as it was set back.
///
/// Set back is plain. A jump forward may be a pause that was: it is a step where a stream of events
/// goes across it whose own time does not go along. Threads: one.
class ClockSteps {
 public:
    /// Every message of the recording, in its order; `packet`: where it is one.
    void take(std::int64_t log_time_ns, const std::optional<PacketFields>& packet);

    /// In order; at most most_steps.
    std::vector<ClockStep> steps() const;

    static constexpr std::size_t most_steps = 10'000;

    /// Less back is a thread that was late with its message.
    static constexpr std::int64_t least_back_ns = 1'000'000'000;

    /// Less forward is waited for: streams that are played slowly have such gaps.
    static constexpr std::int64_t least_forward_ns = 10'000'000'000;

 private:
    /// The packet of a stream that came last.
    struct Last {
        std::uint64_t message;
        std::int64_t base_time_us;
    };
    struct Jump {
        std::uint64_t message;
        std::int64_t by_ns;
        bool step;
    };

    void judge(const Last& last, std::int64_t base_time_us);

    std::uint64_t messages_ = 0;
    std::int64_t log_time_ns_ = 0;  ///< Of the last message.
    std::vector<Jump> jumps_;
    std::map<std::uint64_t, Last> streams_;  ///< By stream id.
};

/// Goes through a recording again and gives its log times without the steps. Threads: one.
class SteppedTime {
 public:
    explicit SteppedTime(std::vector<ClockStep> steps = {}) : steps_(std::move(steps)) {}

    /// When the next message of the file is due, in its turn.
    std::int64_t next(std::int64_t log_time_ns);

 private:
    std::vector<ClockStep> steps_;
    std::size_t passed_ = 0;
    std::uint64_t messages_ = 0;
};

}  // namespace pursuit::recorder
