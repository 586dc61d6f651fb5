// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/flow_control.hpp"

#include <chrono>
#include <thread>
#include <utility>

namespace pursuit::recorder {
namespace {

/// The writer keeps 64 packets: with half of them unacknowledged none is overwritten unsent.
constexpr std::size_t most_unacknowledged = 32;

/// A reader that has not acknowledged for so long is stuck; the others wait no longer for it.
constexpr auto acknowledged_within = std::chrono::milliseconds(2000);

}  // namespace

void FlowControl::hold_back(ReplayChannel& channel, bool hurried, TrackerCalls* calls) {
    if (!hurried) {
        channel.forget_unacknowledged();
        return;
    }
    if (channel.unacknowledged() >= most_unacknowledged) wait_acknowledged(channel);
    if (calls == nullptr) return;
    while (tracker_room_ == 0 && !pace_.stopped()) {
        const auto room = calls->room();
        if (!room) {
            if (!pace_.stopped()) on_error_(room.error().message);
            tracker_room_ = most_unacknowledged;  // go on: others may listen
            return;
        }
        tracker_room_ = *room;
        if (tracker_room_ == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (tracker_room_ > 0) --tracker_room_;
}

void FlowControl::wait_acknowledged(ReplayChannel& channel) {
    constexpr auto step = std::chrono::milliseconds(100);
    for (auto waited = step - step; waited < acknowledged_within; waited += step) {
        if (pace_.stopped() || channel.wait_acknowledged(step)) {
            channel.forget_unacknowledged();
            return;
        }
    }
    channel.forget_unacknowledged();
    if (std::exchange(silence_told_, true)) return;
    on_error_("a reader has not acknowledged for " + std::to_string(acknowledged_within.count()) +
              " ms; the replay goes on without it");
}

}  // namespace pursuit::recorder
