// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose_grid.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::tracker {
namespace {

constexpr std::int64_t second_us = 1'000'000;

}  // namespace

PoseGrid::PoseGrid(double rate_hz, double max_poses_per_s)
    : period_us_(1e6 / rate_hz),
      rate_hz_(rate_hz),
      max_poses_per_s_(max_poses_per_s),
      present_hz_(rate_hz) {}

void PoseGrid::restart() { next_us_ = none; }

std::int64_t PoseGrid::time_of(std::int64_t k) const {
    return std::llround(static_cast<double>(k) * period_us_);
}

std::int64_t PoseGrid::first_at_or_after(std::int64_t t_us) const {
    auto k = static_cast<std::int64_t>(std::floor(static_cast<double>(t_us) / period_us_)) - 1;
    while (time_of(k) < t_us) ++k;
    return k;
}

void PoseGrid::begin(std::int64_t t_us) {
    count_ = next_k_ = first_at_or_after(t_us + 1);
    next_us_ = time_of(next_k_);
    present_hz_ = rate_hz_;
}

void PoseGrid::step() {
    ++count_;
    ++next_k_;
    present_hz_ = rate_hz_;
    const std::int64_t silence_us = time_of(next_k_) - last_event_us_;
    if (silence_us > 3600 * second_us) {
        next_us_ = none;  // The next event begins the grid again.
        return;
    }
    if (silence_us > second_us) {
        const int thinned_hz = silence_us > 60 * second_us ? 1 : 10;
        const std::int64_t spacing_us = second_us / thinned_hz;
        const std::int64_t whole = (next_us_ / spacing_us + 1) * spacing_us;
        next_k_ = std::max(next_k_, first_at_or_after(whole));
        present_hz_ = std::min(rate_hz_, static_cast<double>(thinned_hz));
    }
    next_us_ = time_of(next_k_);
}

bool PoseGrid::is_due(std::uint32_t object_id, std::size_t objects) const {
    const double share = max_poses_per_s_ / (present_hz_ * static_cast<double>(objects));
    if (share >= 1) return true;
    // Evenly: as often as the running total of the share passes a whole number. The id shifts the
    // objects against each other. (Grid times are counted for that: in a silence k goes on by
    // hundreds, and by k some objects would have every pose and others none.)
    const auto k = static_cast<double>(count_ + object_id);
    return std::floor((k + 1) * share) != std::floor(k * share);
}

}  // namespace pursuit::tracker
