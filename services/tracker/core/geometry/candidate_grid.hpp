// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "services/tracker/core/clamped.hpp"

namespace pursuit::tracker {

/// A straight piece of the model as lookups want it: where it begins, the way to its end, and what
/// they need of that way. All of it in one line of the cache.
struct alignas(64) Segment {
    double ax, ay;
    double dx, dy;
    double per_length2 = 0;  ///< 1/length²; 0 for a point.
    double nx = 0, ny = 0;   ///< The unit normal (dy, −dx)/length; 0 for a point.
    double line = 0;         ///< How far along it the piece's line is from the origin.

    Segment(double from_x, double from_y, double to_x, double to_y)
        : ax(from_x), ay(from_y), dx(to_x - from_x), dy(to_y - from_y) {
        const double length2 = dx * dx + dy * dy;
        if (!(length2 > 0)) return;
        per_length2 = 1 / length2;
        const double length = std::sqrt(length2);
        nx = dy / length;
        ny = -dx / length;
        line = nx * ax + ny * ay;
    }
};

/// Of the model frame.
struct Place {
    double x, y;
};

/// Squared length in the image of a vector of the model frame: vᵀ(AᵀA)v.
struct ImageMetric {
    double xx = 1;
    double xy = 0;
    double yy = 1;

    ImageMetric() = default;
    explicit ImageMetric(const Eigen::Matrix2d& a)
        : xx(a(0, 0) * a(0, 0) + a(1, 0) * a(1, 0)),
          xy(a(0, 0) * a(0, 1) + a(1, 0) * a(1, 1)),
          yy(a(0, 1) * a(0, 1) + a(1, 1) * a(1, 1)) {}

    [[nodiscard]] double dot(double ux, double uy, double vx, double vy) const {
        return ux * (xx * vx + xy * vy) + uy * (xy * vx + yy * vy);
    }
    [[nodiscard]] double squared(double vx, double vy) const {
        return xx * vx * vx + 2 * xy * vx * vy + yy * vy * vy;
    }
    [[nodiscard]] double along(double vx, double vy, const Segment& segment) const {
        return dot(vx, vy, segment.dx, segment.dy) / squared(segment.dx, segment.dy);
    }
};

/// Where A keeps angles, what is nearest in the image is nearest in the model frame: lengths are
/// those of the model frame, and need less.
struct ModelMetric {
    [[nodiscard]] double along(double vx, double vy, const Segment& segment) const {
        return (vx * segment.dx + vy * segment.dy) * segment.per_length2;
    }
    [[nodiscard]] double squared(double vx, double vy) const { return vx * vx + vy * vy; }
};

/// A straight piece of the model, px of the model frame; a point where both ends are one.
struct Piece {
    double ax, ay;
    double bx, by;

    /// Where on the piece, 0 (a) … 1 (b), the nearest place to x is in the image metric.
    [[nodiscard]] double foot(double x, double y, const ImageMetric& metric) const {
        const double dx = bx - ax;
        const double dy = by - ay;
        const double length2 = metric.squared(dx, dy);
        if (!(length2 > 0)) return 0;
        const double along = metric.dot(x - ax, y - ay, dx, dy) / length2;
        return along < 0 ? 0 : along > 1 ? 1 : along;
    }
    [[nodiscard]] double squared_distance(double x, double y, const ImageMetric& metric) const {
        const double at = foot(x, y, metric);
        return metric.squared(x - ax - at * (bx - ax), y - ay - at * (by - ay));
    }
};

/// Finds the nearest of a model's pieces exactly, in the image metric. A grid in the model frame:
/// each cell lists every piece that can be the nearest from anywhere in the cell, under any A whose
/// singular values' ratio is at most the anisotropy that the grid was built for. Under very unequal
/// scales that is nearly every piece: what they take to build and to keep is bounded, and lookups
/// are the slower, as exact as ever.
class CandidateGrid {
 public:
    /// So many pieces for each of its cells does a square list at most that is not all of the grid.
    /// (Of contours of 2,000 points no list is longer for it under equal scales, and where scales
    /// differ by a fifth by a tenth, for a build that takes a third of the time.)
    static constexpr std::size_t most_per_cell = 16;

    CandidateGrid() = default;

    /// Without cells: nothing is found until build(). At most 65,536 pieces. Cells are as fine as
    /// asked for, px of the model frame, while there are no more than 65,536.
    explicit CandidateGrid(std::vector<Piece> pieces, double finest_cell_px = 1.5);

    /// Built for all places within reach_px (model frame) of a piece.
    CandidateGrid(std::vector<Piece> pieces, double reach_px, double anisotropy);

    /// Covers all places within reach_px (model frame) of a piece.
    void build(double reach_px, double anisotropy);
    /// Nothing is found until build().
    void forget();

    struct Nearest {
        std::int32_t piece = -1;  ///< -1: beyond the reach.
        double squared_px = 0;    ///< In the image metric. The first of several equally near.
        double foot = 0;          ///< Where on the piece, 0 … 1.
    };

    /// Metric: ImageMetric, or ModelMetric where A keeps angles. (Always inlined: what it gives
    /// stays in registers.)
    template <class Metric>
    [[nodiscard, gnu::always_inline]] Nearest nearest(double x, double y,
                                                      const Metric& metric) const {
        const double column = (x - left_px_) * cells_per_px_;
        const double row = (y - top_px_) * cells_per_px_;
        if (!(column >= 0 && row >= 0 && column < end_column_ && row < end_row_)) return {};
        const Cell cell = cells_[place_of(static_cast<int>(column), static_cast<int>(row))];
        if (cell.others == 0) return {};
        const auto see_point = [&](std::uint16_t i) __attribute__((always_inline)) {
            return seen_point(i, x, y, metric);
        };
        const auto see = [&](std::uint16_t i) __attribute__((always_inline)) {
            return seen(i, x, y, metric);
        };
        return are_points_ ? nearest_in(cell, see_point) : nearest_in(cell, see);
    }

    /// Whether a place is beyond the reach of every piece; may deny it close to that. Of one that
    /// is not, the cell is fetched from memory meanwhile: nearest() is asked next.
    [[nodiscard, gnu::always_inline]] bool is_beyond(double x, double y) const {
        const double column = (x - left_px_) * cells_per_px_;
        const double row = (y - top_px_) * cells_per_px_;
        if (!(column >= 0 && row >= 0 && column < end_column_ && row < end_row_)) return true;
        const std::size_t at = place_of(static_cast<int>(column), static_cast<int>(row));
        __builtin_prefetch(&cells_[at]);
        return (is_within_[at / 64] >> (at % 64) & 1U) == 0;
    }

    /// The nearest of these alone, one or more.
    template <class Metric>
    [[nodiscard, gnu::always_inline]] Nearest nearest_among(std::span<const std::uint16_t> pieces,
                                                            double x, double y,
                                                            const Metric& metric) const {
        const auto see = [&](std::uint16_t i) __attribute__((always_inline)) {
            return seen(i, x, y, metric);
        };
        return nearest_of(see(pieces.front()), pieces.data() + 1, pieces.size() - 1, see);
    }

    [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
    [[nodiscard]] const Segment& segment(std::int32_t piece) const {
        return segments_[static_cast<std::size_t>(piece)];
    }
    /// The place that a lookup found, px of the model frame.
    [[nodiscard]] Eigen::Vector2d place(const Nearest& nearest) const {
        const auto i = static_cast<std::size_t>(nearest.piece);
        if (are_points_) return {points_[i].x, points_[i].y};
        const Segment& segment = segments_[i];
        return {segment.ax + nearest.foot * segment.dx, segment.ay + nearest.foot * segment.dy};
    }
    [[nodiscard]] double reach_px() const { return reach_px_; }
    [[nodiscard]] double anisotropy() const { return anisotropy_; }
    [[nodiscard]] std::size_t cells() const { return cells_.size(); }
    /// Places in lists, of all squares.
    [[nodiscard]] std::size_t listed() const { return others_.size(); }

 private:
    struct Divider;

    /// What can be the nearest from somewhere in it: a first piece and the others, of which there
    /// is at least one, if the same again: most cells have one or two, and nobody could foresee
    /// which. Without others there is none at all. (The first stands here, since every lookup
    /// waits for it.)
    struct Cell {
        std::uint32_t at = 0;  ///< In others_; of one, which it is.
        std::uint16_t others = 0;
        std::uint16_t first = 0;
    };

    template <class See>
    [[nodiscard, gnu::always_inline]] Nearest nearest_in(const Cell& cell, const See& see) const {
        if (cell.others == 1) {
            const auto other = static_cast<std::uint16_t>(cell.at);
            return nearest_of(see(cell.first), &other, 1, see);
        }
        return nearest_of(see(cell.first), others_.data() + cell.at, cell.others, see);
    }

    // Without a branch that nobody could foresee: a squared distance is ordered as its bits are.
    template <class See>
    [[nodiscard, gnu::always_inline]] static Nearest nearest_of(Nearest best,
                                                                const std::uint16_t* others,
                                                                std::size_t count, const See& see) {
        auto squared = std::bit_cast<std::int64_t>(best.squared_px);
        auto foot = std::bit_cast<std::int64_t>(best.foot);
        for (const std::uint16_t* const end = others + count; others != end; ++others) {
            const Nearest other = see(*others);
            const auto other_squared = std::bit_cast<std::int64_t>(other.squared_px);
            const std::int64_t taken = -std::int64_t{other_squared < squared};
            best.piece ^= (best.piece ^ other.piece) & static_cast<std::int32_t>(taken);
            foot ^= (foot ^ std::bit_cast<std::int64_t>(other.foot)) & taken;
            squared ^= (squared ^ other_squared) & taken;
        }
        best.squared_px = std::bit_cast<double>(squared);
        best.foot = std::bit_cast<double>(foot);
        return best;
    }
    template <class Metric>
    [[nodiscard, gnu::always_inline]] Nearest seen_point(std::uint16_t piece, double x, double y,
                                                         const Metric& metric) const {
        const Place& point = points_[piece];
        return {piece, metric.squared(x - point.x, y - point.y), 0};
    }
    // As Piece has it, in the same order.
    template <class Metric>
    [[nodiscard, gnu::always_inline]] Nearest seen(std::uint16_t piece, double x, double y,
                                                   const Metric& metric) const {
        const Segment& segment = segments_[piece];
        const double vx = x - segment.ax;
        const double vy = y - segment.ay;
        // 0 also of a point, whose `along` may be no number.
        const double foot = clamped(metric.along(vx, vy, segment), 0, 1);
        return {piece, metric.squared(vx - foot * segment.dx, vy - foot * segment.dy), foot};
    }

    [[nodiscard]] std::size_t place_of(int column, int row) const {
        return static_cast<std::size_t>(row * columns_ + column);
    }

    std::vector<Piece> pieces_;
    std::vector<Segment> segments_;
    bool are_points_ = false;
    std::vector<Place> points_;  // the same, where all of them are points: less to fetch
    double finest_cell_px_ = 1.5;
    double reach_px_ = -1;
    double anisotropy_ = 0;
    double left_px_ = 0;
    double top_px_ = 0;
    double cells_per_px_ = 1;
    int columns_ = 0;
    int rows_ = 0;
    double end_column_ = 0;  // the same two, as lookups want them
    double end_row_ = 0;
    std::vector<Cell> cells_;
    /// A bit for each cell: whether there is any piece in it. (Of a large shape the cells take half
    /// a megabyte, and nobody could foresee what most events wait for; these stay in the cache.)
    std::vector<std::uint64_t> is_within_;
    std::vector<std::uint16_t> others_;
};

}  // namespace pursuit::tracker
