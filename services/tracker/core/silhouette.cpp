// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/silhouette.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>

namespace pursuit::tracker {
namespace {

constexpr double most_depth_cells = 65536;
constexpr double closed_gap_px = 3;

enum class Side : std::uint8_t { unknown, outside, inside };

}  // namespace

Silhouette::Silhouette(const Contour& contour) {
    const CandidateGrid grid(contour.pieces().pieces(), reach_px, 1);
    const double side_px = 2 * (contour.radius_px() + 4);
    const double cell_px = std::max(1.0, std::sqrt(side_px * side_px / most_depth_cells));
    cells_per_px_ = 1 / cell_px;
    left_px_ = top_px_ = -side_px / 2;
    columns_ = rows_ = static_cast<int>(side_px / cell_px) + 1;
    const auto count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    depth_px_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto column = static_cast<double>(i % static_cast<std::size_t>(columns_));
        const auto row = static_cast<double>(i / static_cast<std::size_t>(columns_));
        const auto nearest = grid.nearest(left_px_ + (column + 0.5) * cell_px,
                                          top_px_ + (row + 0.5) * cell_px, ImageMetric());
        depth_px_[i] = nearest.piece < 0
                           ? static_cast<float>(reach_px)
                           : static_cast<float>(std::min(std::sqrt(nearest.squared_px), reach_px));
    }

    // Outside is what can be reached from the rim without coming near the contour; what is then
    // left and not near the contour is inside. The cells near it belong to the side next to them.
    const auto wall_px = static_cast<float>(closed_gap_px / 2 + 0.1);
    std::vector<Side> sides(count, Side::unknown);
    std::deque<std::size_t> front;
    const auto spread = [&](bool through_wall) {
        while (!front.empty()) {
            const std::size_t i = front.front();
            front.pop_front();
            const int column = static_cast<int>(i) % columns_;
            const int row = static_cast<int>(i) / columns_;
            for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
                if (column + dx < 0 || column + dx >= columns_ || row + dy < 0 ||
                    row + dy >= rows_) {
                    continue;
                }
                const auto j = static_cast<std::size_t>((row + dy) * columns_ + column + dx);
                if (sides[j] != Side::unknown || (!through_wall && depth_px_[j] < wall_px))
                    continue;
                sides[j] = sides[i];
                front.push_back(j);
            }
        }
    };
    sides[0] = Side::outside;
    front.push_back(0);
    spread(false);
    for (std::size_t i = 0; i < count; ++i) {
        if (sides[i] == Side::unknown && depth_px_[i] >= wall_px) {
            sides[i] = Side::inside;
            covers_nothing_ = false;
        }
        if (sides[i] != Side::unknown) front.push_back(i);
    }
    spread(true);
    for (std::size_t i = 0; i < count; ++i) {
        if (sides[i] != Side::inside) depth_px_[i] = -depth_px_[i];
    }
}

}  // namespace pursuit::tracker
