// SPDX-License-Identifier: Apache-2.0
#include "services/common/newcomer_repeats.hpp"

#include <algorithm>

namespace pursuit {

void NewcomerRepeats::matched(const ParticipantKey& participant, std::int64_t now_ns) {
    if (newcomers_.size() >= most) newcomers_.pop_front();
    newcomers_.push_back({participant, now_ns + newcomer_for_ns});
}

void NewcomerRepeats::sent(const RequestKey& request, std::int64_t now_ns) {
    while (!newcomers_.empty() && newcomers_.front().until_ns <= now_ns) newcomers_.pop_front();
    const auto participant = participant_of(request);
    const bool is_new = std::any_of(newcomers_.begin(), newcomers_.end(), [&](const auto& known) {
        return known.participant == participant;
    });
    const bool is_waiting = std::any_of(repeats_.begin(), repeats_.end(), [&](const auto& repeat) {
        return repeat.request == request;
    });
    if (!is_new || is_waiting || repeats_.size() >= most) return;
    repeats_.push_back({request, now_ns + repeat_after_ns});
}

std::vector<RequestKey> NewcomerRepeats::due(std::int64_t now_ns) {
    std::vector<RequestKey> requests;
    while (!repeats_.empty() && repeats_.front().due_ns <= now_ns) {
        requests.push_back(repeats_.front().request);
        repeats_.pop_front();
    }
    return requests;
}

}  // namespace pursuit
