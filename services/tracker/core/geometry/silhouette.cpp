// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/geometry/silhouette.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>

namespace pursuit::tracker {
namespace {

constexpr double most_cells_a_side = 256;
constexpr double closed_gap_px = 3;
constexpr double spare_px = 0.02;  // what is as near as a step needs is near, for sure

// So wide is what lies about the shape's circle, or two cells: the shape nowhere reaches the rim.
constexpr double rim_px = 4;

enum class Side : std::uint8_t { unknown, outside, inside };

}  // namespace

Silhouette::Silhouette(const Contour& contour) {
    const double cell_of_tight_px = 2 * (contour.radius_px() + rim_px) / most_cells_a_side;
    const double side_px = 2 * (contour.radius_px() + std::max(rim_px, 2 * cell_of_tight_px));
    const double cell_px = std::max(1.0, side_px / most_cells_a_side);
    cells_per_px_ = 1 / cell_px;
    left_px_ = top_px_ = -side_px / 2;
    // No step from a cell to the next leads through the contour, nor through a small gap of it,
    // without one of the two being as near as this: half a step along the gap and half the gap.
    const double wall_px = std::hypot(closed_gap_px, cell_px) / 2 + spare_px;
    const double seen_px = std::max(reach_px, wall_px + 1);
    const CandidateGrid grid(contour.pieces().pieces(), seen_px, 1);
    columns_ = rows_ = static_cast<int>(side_px / cell_px) + 1;
    const auto count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    depth_px_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto column = static_cast<double>(i % static_cast<std::size_t>(columns_));
        const auto row = static_cast<double>(i / static_cast<std::size_t>(columns_));
        const auto nearest = grid.nearest(left_px_ + (column + 0.5) * cell_px,
                                          top_px_ + (row + 0.5) * cell_px, ImageMetric());
        depth_px_[i] =
            static_cast<float>(nearest.piece < 0 ? seen_px : std::sqrt(nearest.squared_px));
    }

    // Outside is what can be reached from the rim without coming near the contour; what is then
    // left and not near the contour is inside. The cells near it belong to the side next to them.
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
                if (sides[j] != Side::unknown || (!through_wall && depth_px_[j] < wall_px)) {
                    continue;
                }
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
        const float depth_px = std::min(depth_px_[i], static_cast<float>(reach_px));
        depth_px_[i] = sides[i] == Side::inside ? depth_px : -depth_px;
    }
}

}  // namespace pursuit::tracker
