// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/geometry/candidate_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace pursuit::tracker {
namespace {

constexpr double most_cells = 65536;
// What a bound must be passed by to be passed: places on a cell's rim may be rounded into it.
constexpr double hair = 1e-8;
// Where scales are more unequal than this, lists hardly shrink from a square to its quarters.
constexpr double very_unequal = 2;
constexpr std::size_t most_per_cell_of_unequal = 4;

double squared(const Place& l, const Place& r) {
    return (l.x - r.x) * (l.x - r.x) + (l.y - r.y) * (l.y - r.y);
}

/// The place of a piece that is nearest to another place.
Place foot(const Piece& piece, const Place& place) {
    const double at = piece.foot(place.x, place.y, ImageMetric());
    return {piece.ax + at * (piece.bx - piece.ax), piece.ay + at * (piece.by - piece.ay)};
}

}  // namespace

/// Quarters a square of cells down to one, passing on only the pieces that can still be the nearest
/// from somewhere in it. What lists too many for its cells stays whole: its quarters would list
/// nearly all of them again (most_per_cell).
///
/// A piece cannot where a place of another piece is nearer from everywhere in the square. For a
/// place o of another and each place p of the piece that is so when it is so from the square's
/// corners: what is nearer to o than to p is a half plane. Under other metrics it is, too, where it
/// holds by a margin:
///  - by the anisotropy κ as a factor: |x−p| ≥ κ|x−o| is a disc about o, convex as well; or
///  - −u·w ≥ s·|u||w| with u = p−o, w = x−(p+o)/2, s = (κ²−1)/(κ²+1): a cone of x. No metric turns
///    a direction by more than asin s (Wielandt), so the image has u and w at an obtuse angle
///    still.
struct CandidateGrid::Divider {
    CandidateGrid& grid;
    std::size_t most_a_cell =
        grid.anisotropy_ > very_unequal ? most_per_cell_of_unequal : most_per_cell;
    std::vector<std::uint16_t> last_list = {};
    Cell last_cell = {};

    using List = std::vector<std::uint16_t>;

    /// A piece seen from a square: from its centre and its corners.
    static constexpr std::size_t places = 5;
    struct View {
        std::array<double, places> squared_px;
        std::array<Place, places> foot;
    };
    using Square = std::array<Place, places>;

    // Kept between calls: laying out a large contour makes ten thousands of them.
    std::vector<View> views = {};
    std::vector<List> kept_by_depth = std::vector<List>(32);

    void divide(int column, int row, int size, const List& candidates, std::size_t depth = 0) {
        if (column >= grid.columns_ || row >= grid.rows_) return;
        if (candidates.size() == 1) {
            fill(column, row, size, candidates);
            return;
        }
        const double half_px = size / grid.cells_per_px_ / 2 * (1 + hair) + hair;
        const Place centre{grid.left_px_ + (column + size / 2.0) / grid.cells_per_px_,
                           grid.top_px_ + (row + size / 2.0) / grid.cells_per_px_};
        const Square square{centre, Place{centre.x - half_px, centre.y - half_px},
                            Place{centre.x + half_px, centre.y - half_px},
                            Place{centre.x - half_px, centre.y + half_px},
                            Place{centre.x + half_px, centre.y + half_px}};
        views.resize(candidates.size());
        std::array<std::size_t, places> nearest{};
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            views[i] = view(grid.pieces_[candidates[i]], square);
            for (std::size_t k = 0; k < places; ++k) {
                if (views[i].squared_px[k] < views[nearest[k]].squared_px[k]) nearest[k] = i;
            }
        }
        const double beyond_px = grid.reach_px_ + half_px * std::sqrt(2.0);
        if (views[nearest[0]].squared_px[0] > beyond_px * beyond_px) return;
        List& kept = kept_by_depth[depth];
        kept.clear();
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            bool is_beaten = false;
            for (std::size_t k = 0; k < places && !is_beaten; ++k) {
                is_beaten = nearest[k] != i && beats(views[nearest[k]].foot[k],
                                                     grid.pieces_[candidates[i]], views[i], square);
            }
            if (!is_beaten) kept.push_back(candidates[i]);
        }
        const int half = size / 2;
        if (size == 1 || kept.size() == 1) {
            fill(column, row, size, kept);
            return;
        }
        const auto cells_of_quarter = static_cast<std::size_t>(half) * half;
        if (kept.size() > most_a_cell * cells_of_quarter) {
            fill_near(column, row, size, kept);
            return;
        }
        divide(column, row, half, kept, depth + 1);
        divide(column + half, row, half, kept, depth + 1);
        divide(column, row + half, half, kept, depth + 1);
        divide(column + half, row + half, half, kept, depth + 1);
    }

    /// What is beyond the reach in a square that stays whole is empty as ever.
    void fill_near(int column, int row, int size, const List& kept) {
        const double half_px = 1 / grid.cells_per_px_ / 2 * (1 + hair) + hair;
        const double beyond_px = grid.reach_px_ + half_px * std::sqrt(2.0);
        const Cell cell = cell_of(kept);
        // Mostly what was near the last cell is near the next one as well.
        std::uint16_t near = kept.front();
        for (int y = row; y < std::min(row + size, grid.rows_); ++y) {
            for (int x = column; x < std::min(column + size, grid.columns_); ++x) {
                const Place centre{grid.left_px_ + (x + 0.5) / grid.cells_per_px_,
                                   grid.top_px_ + (y + 0.5) / grid.cells_per_px_};
                const auto is_near = [&](std::uint16_t i) {
                    return squared(foot(grid.pieces_[i], centre), centre) <= beyond_px * beyond_px;
                };
                if (!is_near(near)) {
                    const auto found = std::find_if(kept.begin(), kept.end(), is_near);
                    if (found == kept.end()) continue;
                    near = *found;
                }
                put(x, y, cell);
            }
        }
    }

    static View view(const Piece& piece, const Square& square) {
        View view{};
        for (std::size_t k = 0; k < places; ++k) {
            view.foot[k] = foot(piece, square[k]);
            view.squared_px[k] = squared(view.foot[k], square[k]);
        }
        return view;
    }

    [[nodiscard]] bool beats(const Place& by, const Piece& piece, const View& view,
                             const Square& square) const {
        const double ratio2 = grid.anisotropy_ * grid.anisotropy_;
        std::array<double, places> by2{};
        bool by_factor = true;
        for (std::size_t k = 1; k < places; ++k) {
            by2[k] = squared(by, square[k]);
            const double own2 = view.squared_px[k];
            by_factor &= own2 > ratio2 * by2[k] + hair * (own2 + 1);
        }
        if (by_factor || ratio2 < 1 + 1e-5) return by_factor;

        const double s = (ratio2 - 1) / (ratio2 + 1);
        const Place a{piece.ax, piece.ay};
        const Place b{piece.bx, piece.by};
        const Place a_middle{(a.x + by.x) / 2, (a.y + by.y) / 2};
        const Place b_middle{(b.x + by.x) / 2, (b.y + by.y) / 2};
        const double u2 = std::max(squared(a, by), squared(b, by));
        for (std::size_t k = 1; k < places; ++k) {
            const double own2 = view.squared_px[k];
            const double room2 = own2 - by2[k] - hair * (own2 + 1);
            const double w2 = std::max(squared(a_middle, square[k]), squared(b_middle, square[k]));
            if (!(room2 > 0 && room2 * room2 > 4 * s * s * u2 * w2)) return false;
        }
        return true;
    }

    void fill(int column, int row, int size, const List& kept) {
        const Cell cell = cell_of(kept);
        for (int y = row; y < std::min(row + size, grid.rows_); ++y) {
            for (int x = column; x < std::min(column + size, grid.columns_); ++x) {
                put(x, y, cell);
            }
        }
    }

    void put(int column, int row, const Cell& cell) {
        const std::size_t at = grid.place_of(column, row);
        grid.cells_[at] = cell;
        grid.is_within_[at / 64] |= std::uint64_t{1} << (at % 64);
    }

    Cell cell_of(const List& kept) {
        if (kept == last_list) return last_cell;
        last_list = kept;
        if (kept.size() <= 2) {
            last_cell = {kept.back(), 1, kept.front()};
            return last_cell;
        }
        last_cell = {static_cast<std::uint32_t>(grid.others_.size()),
                     static_cast<std::uint16_t>(kept.size() - 1), kept.front()};
        grid.others_.insert(grid.others_.end(), kept.begin() + 1, kept.end());
        return last_cell;
    }
};

CandidateGrid::CandidateGrid(std::vector<Piece> pieces, double finest_cell_px)
    : pieces_(std::move(pieces)), finest_cell_px_(finest_cell_px) {
    are_points_ = true;
    for (const Piece& piece : pieces_) {
        segments_.emplace_back(piece.ax, piece.ay, piece.bx, piece.by);
        are_points_ &= piece.ax == piece.bx && piece.ay == piece.by;
    }
    if (!are_points_) return;
    for (const Piece& piece : pieces_) points_.push_back({piece.ax, piece.ay});
}

CandidateGrid::CandidateGrid(std::vector<Piece> pieces, double reach_px, double anisotropy)
    : CandidateGrid(std::move(pieces)) {
    build(reach_px, anisotropy);
}

void CandidateGrid::forget() {
    reach_px_ = -1;
    anisotropy_ = 0;
    end_column_ = end_row_ = 0;
}

void CandidateGrid::build(double reach_px, double anisotropy) {
    reach_px_ = reach_px;
    anisotropy_ = anisotropy;
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
    const double cell_px = std::max(finest_cell_px_, std::sqrt(width_px * height_px / most_cells));
    cells_per_px_ = 1 / cell_px;
    columns_ = static_cast<int>(width_px / cell_px) + 1;
    rows_ = static_cast<int>(height_px / cell_px) + 1;
    end_column_ = columns_;
    end_row_ = rows_;
    cells_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), {});
    is_within_.assign(cells_.size() / 64 + 1, 0);
    others_.clear();

    std::vector<std::uint16_t> all(pieces_.size());
    std::iota(all.begin(), all.end(), std::uint16_t{0});
    int size = 1;
    while (size < std::max(columns_, rows_)) size *= 2;
    Divider{*this}.divide(0, 0, size, all);
}

}  // namespace pursuit::tracker
