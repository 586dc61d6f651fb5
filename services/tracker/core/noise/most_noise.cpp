// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/most_noise.hpp"

#include <cmath>
#include <limits>

namespace pursuit::tracker {
namespace {

constexpr double beyond_px = 32;

// So many tell a share of two thirds to 2 %.
constexpr int a_side = 24;
constexpr int least_pixels = 100;

}  // namespace

double most_noise_hz(std::int64_t t_us, std::int64_t over_us, const Eigen::Vector2d& middle_px,
                     double extent_px, const RecentPixels& pixels) {
    const double reach_px = extent_px + beyond_px;
    const double step_px = 2 * reach_px / a_side;
    const Eigen::Vector2d first = middle_px.array() - reach_px + step_px / 2;
    int looked_at = 0;
    int fired = 0;
    for (int row = 0; row < a_side; ++row) {
        for (int column = 0; column < a_side; ++column) {
            const auto last_us = pixels.last_us(first + step_px * Eigen::Vector2d(column, row));
            if (!last_us) continue;
            ++looked_at;
            fired += t_us - *last_us < over_us ? 1 : 0;
        }
    }
    if (looked_at < least_pixels || over_us <= 0) return std::numeric_limits<double>::infinity();
    // Of all of them half a pixel at least was silent by chance.
    const double silent = (looked_at - fired + 0.5) / (looked_at + 0.5);
    return -std::log(silent) / (static_cast<double>(over_us) * 1e-6);
}

}  // namespace pursuit::tracker
