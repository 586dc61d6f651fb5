// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>

namespace pursuit::sensor {

/// Ends waits on descriptors, once and for all. Threads: any.
class StopSignal {
 public:
    StopSignal();
    ~StopSignal();
    StopSignal(const StopSignal&) = delete;
    StopSignal& operator=(const StopSignal&) = delete;

    void raise();
    bool raised() const { return raised_.load(); }

    /// Waits until `file` (−1: nothing) is ready for `events` of poll(2), for `at_most` (negative:
    /// for ever). False when the time is over, or the signal was raised.
    bool wait(int file, short events, std::chrono::milliseconds at_most) const;

 private:
    std::atomic<bool> raised_{false};
    int event_;
};

}  // namespace pursuit::sensor
