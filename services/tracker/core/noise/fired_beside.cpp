// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/fired_beside.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pursuit::tracker {
namespace {

constexpr float left_out = -1;

// Of the variance of a count what is left when it is spread: (1² + 2² + 1²)² / 16².
constexpr double spread_variance = 36.0 / 256;

// Fewer pixels tell nothing: chance alone lets the ratio of so many stray by 0.12 (what is spread
// is as a fourth of them).
constexpr double least_pixels = 500;

}  // namespace

void FiredBeside::begin(unsigned side) {
    side_ = static_cast<int>(side);
    counts_.assign(std::size_t{side} * side, 0);
}

void FiredBeside::add(std::span<const float> counts) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += counts[i];
}

void FiredBeside::leave_out(const Eigen::Vector2d& place_px) {
    const auto column = static_cast<int>(std::lround(place_px.x()));
    const auto row = static_cast<int>(std::lround(place_px.y()));
    const int left = std::max(column - near_px, 0);
    const int right = std::min(column + near_px + 1, side_);
    for (int y = std::max(row - near_px, 0); y < std::min(row + near_px + 1, side_); ++y) {
        for (int x = left; x < right; ++x)
            counts_[static_cast<std::size_t>(y * side_ + x)] = left_out;
    }
}

double FiredBeside::unevenness(const Eigen::Vector2d& middle_px, double radius_px,
                               const FiredBox& seen) const {
    const auto first = [](int seen_from, double from) {
        return std::max({0, seen_from + 1, static_cast<int>(std::ceil(from))});
    };
    const auto last = [&](int seen_to, double to) {
        return std::min({side_ - 1, seen_to - 1, static_cast<int>(std::floor(to))});
    };
    double pixels = 0;
    double sum = 0;
    double squares = 0;
    const int bottom = last(seen.bottom, middle_px.y() + radius_px);
    for (int row = first(seen.top, middle_px.y() - radius_px); row <= bottom; ++row) {
        const double down_px = row - middle_px.y();
        const double half_px = std::sqrt(std::max(radius_px * radius_px - down_px * down_px, 0.0));
        const int right = last(seen.right, middle_px.x() + half_px);
        for (int column = first(seen.left, middle_px.x() - half_px); column <= right; ++column) {
            const double fired = counts_[static_cast<std::size_t>(row * side_ + column)];
            const double is_beside = fired < 0 ? 0 : 1;
            pixels += is_beside;
            sum += is_beside * fired;
            squares += is_beside * fired * fired;
        }
    }
    if (pixels < least_pixels || !(sum > 0)) return 1;
    return (squares - sum * sum / pixels) / (spread_variance * sum);
}

}  // namespace pursuit::tracker
