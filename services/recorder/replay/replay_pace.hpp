// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

#include "services/common/clock.hpp"

namespace pursuit::recorder {

/// Says when each message of a recording is due: its log time, times a rate that may change, with
/// pauses in which time stops. Rate 0: at once.
///
/// A message that is late (the process was stopped, a reader was slow) is due at once; the schedule
/// stays, so the replay catches up. Threads: wait() by one, the rest by any.
class ReplayPace {
 public:
    struct Due {
        std::int64_t realtime_ns;  ///< CLOCK_REALTIME at which it was due, which may be past.
        std::int64_t late_ns;      ///< How far.
        double rate;
    };

    ReplayPace(Clock& clock, double rate) : clock_(clock), rate_(rate) {}

    /// Waits until the message of that log time is due; nothing when stopped. The first message
    /// after the start, or after restart(), is due at once.
    std::optional<Due> wait(std::int64_t log_time_ns);

    void restart();
    void set_rate(double rate);
    void pause(bool paused);
    void stop();

    double rate() const;
    bool paused() const;
    bool stopped() const;

 private:
    void anchor_here();

    Clock& clock_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    double rate_;
    bool paused_ = false;
    bool stopped_ = false;
    bool anchored_ = false;  ///< From here on: log time `log_ns_` is at steady time `steady_ns_`.
    std::int64_t log_ns_ = 0;
    std::int64_t steady_ns_ = 0;
};

}  // namespace pursuit::recorder
