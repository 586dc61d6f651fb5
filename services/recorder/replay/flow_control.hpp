// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "services/recorder/replay/replay_channel.hpp"
#include "services/recorder/replay/replay_pace.hpp"
#include "services/recorder/replay/tracker_calls.hpp"

namespace pursuit::recorder {

/// Holds a replay that goes as fast as it can back to what its readers and trackers can take.
///
/// Acknowledged is what a reader has; what its tracker has dealt with only the tracker knows. As
/// fast as possible must not mean faster than that: its queue drops what it cannot hold. Nothing
/// waits once the pace is stopped, nor for ever: who is silent for too long is left behind, and
/// told of. Threads: one.
class FlowControl {
 public:
    using OnError = std::function<void(const std::string&)>;

    /// `pace` must outlive it; it only says when to give up.
    FlowControl(const ReplayPace& pace, OnError on_error)
        : pace_(pace), on_error_(std::move(on_error)) {}

    /// What was known of the trackers' room holds no more: another pass begins.
    void restart() { tracker_room_ = 0; }

    /// Waits until one more message of this channel may be written. hurried: the replay is late, or
    /// paced by nothing; otherwise it never waits. `calls`: the trackers that packets go to; null
    /// where the channel carries none or nobody is to be asked.
    void hold_back(ReplayChannel& channel, bool hurried, TrackerCalls* calls);

    /// Waits until the readers of this channel have everything.
    void wait_acknowledged(ReplayChannel& channel);

 private:
    const ReplayPace& pace_;
    const OnError on_error_;
    std::size_t tracker_room_ = 0;  ///< Packets that may be sent before the trackers are asked.
    bool silence_told_ = false;     ///< Of readers that do not acknowledge.
};

}  // namespace pursuit::recorder
