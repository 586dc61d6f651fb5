// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/replay_pace.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::recorder {

std::optional<ReplayPace::Due> ReplayPace::wait(std::int64_t log_time_ns) {
    std::unique_lock lock(mutex_);
    while (!stopped_) {
        if (paused_) {
            clock_.wait_until(lock, changed_, Clock::never_ns);
            continue;
        }
        const auto now_ns = clock_.steady_ns();
        if (!anchored_ || rate_ == 0) {
            anchored_ = true;
            log_ns_ = log_time_ns;
            steady_ns_ = now_ns;
            return Due{clock_.realtime_ns(), 0, rate_};
        }
        const auto due_ns =
            steady_ns_ + std::llround(static_cast<double>(log_time_ns - log_ns_) / rate_);
        if (due_ns <= now_ns) {
            const auto late_ns = now_ns - due_ns;
            return Due{clock_.realtime_ns() - late_ns, late_ns, rate_};
        }
        clock_.wait_until(lock, changed_, due_ns);
    }
    return std::nullopt;
}

// The log time of now becomes the anchor, so that what changes holds from now on.
void ReplayPace::anchor_here() {
    const auto now_ns = clock_.steady_ns();
    if (anchored_ && !paused_ && rate_ > 0) {
        log_ns_ += std::llround(static_cast<double>(now_ns - steady_ns_) * rate_);
    }
    steady_ns_ = now_ns;
}

void ReplayPace::restart() {
    const std::scoped_lock lock(mutex_);
    anchored_ = false;
}

void ReplayPace::set_rate(double rate) {
    const std::scoped_lock lock(mutex_);
    anchor_here();
    rate_ = rate;
    changed_.notify_all();
}

void ReplayPace::pause(bool paused) {
    const std::scoped_lock lock(mutex_);
    anchor_here();
    paused_ = paused;
    changed_.notify_all();
}

void ReplayPace::stop() {
    const std::scoped_lock lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
}

double ReplayPace::rate() const {
    const std::scoped_lock lock(mutex_);
    return rate_;
}

bool ReplayPace::paused() const {
    const std::scoped_lock lock(mutex_);
    return paused_;
}

bool ReplayPace::stopped() const {
    const std::scoped_lock lock(mutex_);
    return stopped_;
}

}  // namespace pursuit::recorder
