// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/pacer.hpp"

#include <algorithm>

namespace pursuit::sensor {
namespace {

constexpr double far_ns = 4e18;  // 127 years: beyond it only the clock's range matters

}  // namespace

Pacer::Pacer(Clock& clock, double rate) : clock_(clock), rate_(rate) {}

std::int64_t Pacer::due_ns(std::int64_t t_us) const {
    const double wall_ns = static_cast<double>(t_us - tie_->t_us) * 1e3 / rate_;
    if (wall_ns >= far_ns) return Clock::never_ns;
    return tie_->steady_ns + static_cast<std::int64_t>(std::max(wall_ns, -far_ns));
}

bool Pacer::wait_until(std::int64_t t_us) {
    std::unique_lock lock(mutex_);
    while (!stopped_) {
        if (paused_) {
            clock_.wait_until(lock, changed_, Clock::never_ns);
            continue;
        }
        if (rate_ == 0) {
            lag_us_ = 0;
            return true;
        }
        const auto now_ns = clock_.steady_ns();
        if (!tie_) {
            // What was reached before a pause lies at or before t_us: the rest is waited for.
            tie_ = Tie{std::min(reached_us_.value_or(t_us), t_us), now_ns};
            reached_us_.reset();
        }
        const auto due = due_ns(t_us);
        if (due <= now_ns) {
            lag_us_ = (now_ns - due) / 1000;
            return true;
        }
        clock_.wait_until(lock, changed_, due);
    }
    return false;
}

void Pacer::hold() {
    if (!tie_) return;
    const double passed_us = static_cast<double>(clock_.steady_ns() - tie_->steady_ns) / 1e3;
    reached_us_ = tie_->t_us + static_cast<std::int64_t>(passed_us * rate_);
    tie_.reset();
}

void Pacer::set_rate(double rate) {
    const std::lock_guard lock(mutex_);
    hold();
    if (rate == 0) reached_us_.reset();
    rate_ = rate;
    changed_.notify_all();
}

void Pacer::pause() {
    const std::lock_guard lock(mutex_);
    hold();
    paused_ = true;
    changed_.notify_all();
}

void Pacer::resume() {
    const std::lock_guard lock(mutex_);
    paused_ = false;
    changed_.notify_all();
}

void Pacer::stop() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
}

void Pacer::restart() {
    const std::lock_guard lock(mutex_);
    tie_.reset();
    reached_us_.reset();
}

double Pacer::rate() const {
    const std::lock_guard lock(mutex_);
    return rate_;
}

bool Pacer::paused() const {
    const std::lock_guard lock(mutex_);
    return paused_;
}

bool Pacer::stopped() const {
    const std::lock_guard lock(mutex_);
    return stopped_;
}

std::int64_t Pacer::lag_us() const {
    const std::lock_guard lock(mutex_);
    return lag_us_;
}

std::int64_t Pacer::host_time_ns(std::int64_t t_us) const {
    const std::lock_guard lock(mutex_);
    const auto now_ns = clock_.realtime_ns();
    if (!tie_) return now_ns;
    return now_ns + (due_ns(t_us) - clock_.steady_ns());
}

}  // namespace pursuit::sensor
