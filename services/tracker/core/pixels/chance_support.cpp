// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pixels/chance_support.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::tracker {
namespace {

constexpr std::size_t least_tiles = 16;
constexpr int neighbours = 8;

}  // namespace

void ChanceSupport::begin(int width_px, int height_px) {
    columns_ = std::max(width_px, 0) / tile_px;
    rows_ = std::max(height_px, 0) / tile_px;
    fired_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
}

int ChanceSupport::least_neighbours(double over_us, double within_us, double by_chance) {
    if (fired_.size() < least_tiles || !(over_us > 0)) return 1;
    const auto quiet = fired_.begin() + static_cast<std::ptrdiff_t>(fired_.size() / 4);
    std::nth_element(fired_.begin(), quiet, fired_.end());
    // One more was silent by chance.
    constexpr double pixels = tile_px * tile_px;
    const double silent = (pixels - *quiet + 1) / (pixels + 1);
    const double p = 1 - std::pow(silent, within_us / over_us);
    // All of them fire, so surely that nothing is left to reckon with.
    if (!(p < 1)) return neighbours;
    // Of eight, so many or more.
    double exactly = std::pow(1 - p, neighbours);
    double beyond = 1 - exactly;
    int least = 1;
    for (; least < neighbours && beyond > by_chance; ++least) {
        exactly *= p / (1 - p) * (neighbours + 1 - least) / least;
        beyond -= exactly;
    }
    return least;
}

}  // namespace pursuit::tracker
