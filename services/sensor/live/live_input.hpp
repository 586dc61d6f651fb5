// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

#include "services/sensor/live/live_sink.hpp"
#include "services/sensor/live/stop_signal.hpp"

namespace pursuit::sensor {

/// A live source of events: hears one stream after another until it is stopped.
class LiveInput {
 public:
    virtual ~LiveInput() = default;

    /// Hands streams to `sink` until `stop` is raised, or the source has ended for good. Runs on a
    /// thread of its own, and returns within 1 s of the signal.
    virtual void run(LiveSink& sink, const StopSignal& stop) = 0;
};

/// How long to wait before the next attempt: 10 ms at first, twice as long each time, at most
/// `longest`. A stream that delivered something begins again at 10 ms.
class BackOff {
 public:
    explicit BackOff(std::chrono::milliseconds longest) : longest_(longest) {}

    void succeeded() { next_ = first; }
    std::chrono::milliseconds next() {
        const auto wait = std::min(next_, longest_);
        next_ = std::min(2 * wait, longest_);
        return wait;
    }

 private:
    static constexpr std::chrono::milliseconds first{10};
    std::chrono::milliseconds longest_;
    std::chrono::milliseconds next_ = first;
};

}  // namespace pursuit::sensor
