// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace pursuit::tracker {

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
/// singular values' ratio is at most the anisotropy that the grid was built for.
class CandidateGrid {
 public:
    CandidateGrid() = default;

    /// Without cells: nothing is found until build(). At most 65,536 pieces. Cells are as fine as
    /// asked for, px of the model frame, while there are no more than 65,536.
    explicit CandidateGrid(std::vector<Piece> pieces, double finest_cell_px = 1.5);

    /// Built for all places within reach_px (model frame) of a piece.
    CandidateGrid(std::vector<Piece> pieces, double reach_px, double anisotropy);

    /// Covers all places within reach_px (model frame) of a piece.
    void build(double reach_px, double anisotropy);

    struct Nearest {
        std::int32_t piece = -1;  ///< -1: beyond the reach.
        double squared_px = 0;    ///< In the image metric. The first of several equally near.
        double foot = 0;          ///< Where on the piece, 0 … 1.
    };

    [[nodiscard]] Nearest nearest(double x, double y, const ImageMetric& metric) const {
        const double column = (x - left_px_) * cells_per_px_;
        const double row = (y - top_px_) * cells_per_px_;
        if (!(column >= 0 && row >= 0 && column < columns_ && row < rows_)) return {};
        // Signed, for which there is one conversion.
        const auto cell = static_cast<std::int64_t>(static_cast<std::int32_t>(row)) * columns_ +
                          static_cast<std::int32_t>(column);
        const std::uint16_t* listed = &listed_[list_of_[static_cast<std::size_t>(cell)]];
        const std::size_t count = *listed++;
        if (count == 0) return {};
        return are_points_ ? nearest_point(listed, count, x, y, metric)
                           : nearest_side(listed, count, x, y, metric);
    }

    [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
    [[nodiscard]] double reach_px() const { return reach_px_; }
    [[nodiscard]] double anisotropy() const { return anisotropy_; }
    /// Of the cells that list any.
    [[nodiscard]] double mean_candidates() const;

 private:
    /// A piece by its beginning and its way to the end.
    struct Side {
        double ax, ay;
        double dx, dy;
    };
    struct Divider;

    // What is nearer is chosen without a branch: which one it will be cannot be foreseen.
    [[nodiscard]] Nearest nearest_point(const std::uint16_t* listed, std::size_t count, double x,
                                        double y, const ImageMetric& metric) const {
        const auto squared_px = [&](std::size_t piece) {
            return metric.squared(x - sides_[piece].ax, y - sides_[piece].ay);
        };
        Nearest best{listed[0], squared_px(listed[0]), 0};
        for (std::size_t i = 1; i < count; ++i) {
            const double squared = squared_px(listed[i]);
            const bool is_nearer = squared < best.squared_px;
            best.squared_px = is_nearer ? squared : best.squared_px;
            best.piece = is_nearer ? listed[i] : best.piece;
        }
        return best;
    }
    [[nodiscard]] Nearest nearest_side(const std::uint16_t* listed, std::size_t count, double x,
                                       double y, const ImageMetric& metric) const {
        // As Piece has it, in the same order.
        const auto measured = [&](std::size_t piece) -> Nearest {
            const Side& side = sides_[piece];
            const double qx = x - side.ax;
            const double qy = y - side.ay;
            const double along =
                metric.dot(qx, qy, side.dx, side.dy) / metric.squared(side.dx, side.dy);
            double foot = along > 0 ? along : 0;  // also of a point, whose `along` is no number
            foot = foot > 1 ? 1 : foot;
            return {static_cast<std::int32_t>(piece),
                    metric.squared(qx - foot * side.dx, qy - foot * side.dy), foot};
        };
        Nearest best = measured(listed[0]);
        for (std::size_t i = 1; i < count; ++i) {
            const Nearest other = measured(listed[i]);
            const bool is_nearer = other.squared_px < best.squared_px;
            best.squared_px = is_nearer ? other.squared_px : best.squared_px;
            best.piece = is_nearer ? other.piece : best.piece;
            best.foot = is_nearer ? other.foot : best.foot;
        }
        return best;
    }

    std::vector<Piece> pieces_;
    std::vector<Side> sides_;
    bool are_points_ = false;
    double finest_cell_px_ = 1.5;
    double reach_px_ = -1;
    double anisotropy_ = 0;
    double left_px_ = 0;
    double top_px_ = 0;
    double cells_per_px_ = 1;
    int columns_ = 0;
    int rows_ = 0;
    std::vector<std::uint32_t> list_of_;  // where each cell's list begins
    std::vector<std::uint16_t> listed_;   // the lists: how many, and which, rising
};

}  // namespace pursuit::tracker
