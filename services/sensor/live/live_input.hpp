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
/// `longest`. After a stream that lasted as long it begins again at 10 ms; one that ends at once,
/// again and again, is not worth more haste than none.
class BackOff {
 public:
    explicit BackOff(std::chrono::milliseconds longest) : longest_(longest) {}

    /// What was heard since the last attempt lasted so long.
    void heard(std::chrono::nanoseconds lasted) {
        if (lasted >= longest_) next_ = first;
    }
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
