// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "services/common/request_client.hpp"
#include "services/recorder/replay/replay_plan.hpp"

namespace pursuit::recorder {

/// Calls the trackers that a replay is for. Threads: one, but for cancel().
class TrackerCalls {
 public:
    using Client = RequestClient<v1::TrackerRequest, v1::TrackerReply>;

    /// `plan` says which instances are called. `participant` must outlive it.
    static Result<std::unique_ptr<TrackerCalls>> create(Participant& participant,
                                                        const ReplayPlan& plan);

    /// Whether a tracker hears requests and is heard; waits at most `at_most`.
    bool wait_matched(std::chrono::milliseconds at_most);

    /// Makes one call and waits for the reply. begins_stream: the packet that follows is the first
    /// of its stream and holds nothing before the call's time; a tracker that is still in the
    /// stream before then takes the call as one of now.
    Result<void> make(const PlannedCall& call, bool begins_stream);

    /// How many packets may be sent before this is asked again, by the trackers' own queues: none
    /// while they are full. Without a tracker, room_unasked. An error when one does not answer.
    Result<std::size_t> room();
    static constexpr std::size_t room_unasked = 256;

    void cancel();

    /// A refusal or silence for this long is an error.
    static constexpr auto patience = std::chrono::seconds(5);

 private:
    TrackerCalls() = default;
    std::map<std::string, std::unique_ptr<Client>> clients_;  ///< By instance.
};

}  // namespace pursuit::recorder
