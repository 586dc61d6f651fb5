// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/live/host_time_map.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::sensor {
namespace {

/// A clock is slewed by at most 500 ppm (adjtime); what goes beyond it and scheduling was set.
constexpr double fastest_slew = 600e-6;
constexpr double set_ns = 2e6;

}  // namespace

void HostTimeMap::add(std::int64_t t_us, std::int64_t realtime_ns, std::int64_t steady_ns) {
    const std::scoped_lock lock(mutex_);
    const auto between_ns = realtime_ns - steady_ns;
    const auto moved_ns = static_cast<double>(std::abs(between_ns - between_ns_));
    const auto passed_ns = static_cast<double>(steady_ns - steady_ns_);
    if (moved_ns > set_ns + fastest_slew * passed_ns) least_.clear();
    steady_ns_ = steady_ns;
    between_ns_ = between_ns;

    const Sample sample{t_us, realtime_ns - t_us * 1000};
    if (least_.empty() || steady_ns - begin_ns_ >= second_ns) {
        begin_ns_ = steady_ns;
        least_.push_back(sample);
        if (least_.size() > most_seconds) least_.pop_front();
    } else if (sample.offset_ns < least_.back().offset_ns) {
        least_.back() = sample;
    } else {
        return;  // the line stays
    }
    fit();
}

void HostTimeMap::fit() {
    // Small numbers: about the first sample.
    reference_us_ = least_.front().t_us;
    base_ns_ = least_.front().offset_ns;
    const auto t_us = [this](const Sample& s) {
        return static_cast<double>(s.t_us - reference_us_);
    };
    const auto offset_ns = [this](const Sample& s) {
        return static_cast<double>(s.offset_ns - base_ns_);
    };
    slope_ = 0;
    if (least_.size() > least_seconds) {
        double t_mean = 0, offset_mean = 0;
        const auto count = static_cast<double>(least_.size());
        for (const auto& sample : least_) {
            t_mean += t_us(sample) / count;
            offset_mean += offset_ns(sample) / count;
        }
        double tt = 0, to = 0;
        for (const auto& sample : least_) {
            const double t = t_us(sample) - t_mean;
            tt += t * t;
            to += t * (offset_ns(sample) - offset_mean);
        }
        if (tt > 0) slope_ = to / tt;
    }
    intercept_ns_ = offset_ns(least_.front());
    for (const auto& sample : least_) {
        intercept_ns_ = std::min(intercept_ns_, offset_ns(sample) - slope_ * t_us(sample));
    }
}

void HostTimeMap::restart() {
    const std::scoped_lock lock(mutex_);
    least_.clear();
}

std::optional<std::int64_t> HostTimeMap::host_time_ns(std::int64_t t_us) const {
    const std::scoped_lock lock(mutex_);
    if (least_.empty()) return std::nullopt;
    const double beyond_ns = intercept_ns_ + slope_ * static_cast<double>(t_us - reference_us_);
    return t_us * 1000 + base_ns_ + std::llround(beyond_ns);
}

double HostTimeMap::drift_ppm() const {
    const std::scoped_lock lock(mutex_);
    if (least_.size() <= least_seconds) return 0;
    // A sensor clock that runs fast sees the offset of the host's shrink: dr/dt = 1 + slope.
    return (1 / (1 + slope_ * 1e-3) - 1) * 1e6;
}

}  // namespace pursuit::sensor
