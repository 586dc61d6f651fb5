// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/candidate_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace pursuit::tracker {
namespace {

constexpr double finest_cell_px = 1.5;
constexpr double most_cells = 65536;

}  // namespace

CandidateGrid::CandidateGrid(std::vector<Piece> pieces, double reach_px, double anisotropy)
    : pieces_(std::move(pieces)), reach_px_(reach_px), anisotropy_(anisotropy) {
    double right_px = -1e300;
    double bottom_px = -1e300;
    left_px_ = top_px_ = 1e300;
    for (const Piece& piece : pieces_) {
        left_px_ = std::min({left_px_, piece.ax, piece.bx});
        top_px_ = std::min({top_px_, piece.ay, piece.by});
        right_px = std::max({right_px, piece.ax, piece.bx});
        bottom_px = std::max({bottom_px, piece.ay, piece.by});
    }
    left_px_ -= reach_px;
    top_px_ -= reach_px;
    const double width_px = right_px + reach_px - left_px_;
    const double height_px = bottom_px + reach_px - top_px_;
    const double cell_px = std::max(finest_cell_px, std::sqrt(width_px * height_px / most_cells));
    cells_per_px_ = 1 / cell_px;
    columns_ = static_cast<int>(width_px / cell_px) + 1;
    rows_ = static_cast<int>(height_px / cell_px) + 1;

    std::vector<std::uint16_t> all(pieces_.size());
    std::iota(all.begin(), all.end(), std::uint16_t{0});
    std::vector<std::vector<std::uint16_t>> cells(static_cast<std::size_t>(columns_) *
                                                  static_cast<std::size_t>(rows_));
    int size = 1;
    while (size < std::max(columns_, rows_)) size *= 2;
    divide(0, 0, size, all, cells);

    first_.reserve(cells.size() + 1);
    for (const auto& cell : cells) {
        first_.push_back(static_cast<std::uint32_t>(listed_.size()));
        listed_.insert(listed_.end(), cell.begin(), cell.end());
    }
    first_.push_back(static_cast<std::uint32_t>(listed_.size()));
}

// Quarters a square of cells down to one, passing on only the pieces that can still be the nearest.
void CandidateGrid::divide(int column, int row, int size,
                           const std::vector<std::uint16_t>& candidates,
                           std::vector<std::vector<std::uint16_t>>& cells) const {
    if (column >= columns_ || row >= rows_) return;
    const double side_px = size / cells_per_px_;
    const double x = left_px_ + column / cells_per_px_ + side_px / 2;
    const double y = top_px_ + row / cells_per_px_ + side_px / 2;
    // A hair more than half the diagonal: a place on the rim may be rounded into the cell.
    const double radius_px = side_px * std::numbers::sqrt2 / 2 * (1 + 1e-9) + 1e-9;
    const ImageMetric plain;
    std::vector<double> distance_px(candidates.size());
    double nearest_px = 1e300;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        distance_px[i] = std::sqrt(pieces_[candidates[i]].squared_distance(x, y, plain));
        nearest_px = std::min(nearest_px, distance_px[i]);
    }
    // From a place in the square (within the radius r of its centre) the piece that is nearest to
    // the centre, at d, is at most d+r away, and in the image at most σ_max·(d+r). A piece that
    // beats it there is at most (σ_max/σ_min)·(d+r) away in the model frame.
    const double bound_px = anisotropy_ * (nearest_px + radius_px) + radius_px;
    std::vector<std::uint16_t> kept;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (distance_px[i] <= bound_px) kept.push_back(candidates[i]);
    }
    if (size == 1) {
        const bool reached = nearest_px <= reach_px_ + radius_px;
        if (reached) {
            cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(column)] = std::move(kept);
        }
        return;
    }
    const int half = size / 2;
    divide(column, row, half, kept, cells);
    divide(column + half, row, half, kept, cells);
    divide(column, row + half, half, kept, cells);
    divide(column + half, row + half, half, kept, cells);
}

double CandidateGrid::mean_candidates() const {
    return first_.size() < 2
               ? 0
               : static_cast<double>(listed_.size()) / static_cast<double>(first_.size() - 1);
}

}  // namespace pursuit::tracker
