// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "services/common/request_key.hpp"

namespace pursuit {

/// Which replies are to be sent once more, because their reader has only just been matched.
///
/// A reader of another vendor may begin after the first heartbeat that it hears, and Fast DDS sends
/// that one before the first sample: Cyclone DDS lost 9 to 12 of 25 first replies that way, and
/// none that came 300 ms after the match. So what a newcomer is sent within its first second is
/// sent again 250 ms later.
///
/// Bounded: beyond `most` newcomers the oldest is no newcomer any more; beyond `most` replies the
/// newest is not repeated (its client asks again). Times are steady ones. Threads: one at a time.
class NewcomerRepeats {
 public:
    static constexpr std::int64_t newcomer_for_ns = 1'000'000'000;
    static constexpr std::int64_t repeat_after_ns = 250'000'000;
    static constexpr std::size_t most = 256;

    void matched(const ParticipantKey& participant, std::int64_t now_ns);
    /// The reply to a request was sent.
    void sent(const RequestKey& request, std::int64_t now_ns);
    /// Those whose reply is to be sent again now; each is given once.
    std::vector<RequestKey> due(std::int64_t now_ns);

 private:
    struct Newcomer {
        ParticipantKey participant;
        std::int64_t until_ns;
    };
    struct Repeat {
        RequestKey request;
        std::int64_t due_ns;
    };

    std::deque<Newcomer> newcomers_;  // both in the order of their times
    std::deque<Repeat> repeats_;
};

}  // namespace pursuit
