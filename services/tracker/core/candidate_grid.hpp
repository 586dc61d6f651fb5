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

    /// Covers all places within reach_px (model frame) of a piece. At most 65,536 pieces.
    CandidateGrid(std::vector<Piece> pieces, double reach_px, double anisotropy);

    struct Nearest {
        std::int32_t piece = -1;  ///< -1: beyond the reach.
        double squared_px = 0;    ///< In the image metric. The first of several equally near.
    };

    [[nodiscard]] Nearest nearest(double x, double y, const ImageMetric& metric) const {
        Nearest best;
        const double column = (x - left_px_) * cells_per_px_;
        const double row = (y - top_px_) * cells_per_px_;
        if (!(column >= 0 && row >= 0 && column < columns_ && row < rows_)) return best;
        const auto cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                          static_cast<std::size_t>(column);
        best.squared_px = 1e300;
        for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
            const double squared_px = pieces_[listed_[i]].squared_distance(x, y, metric);
            if (squared_px < best.squared_px) {
                best.squared_px = squared_px;
                best.piece = listed_[i];
            }
        }
        return best;
    }

    [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
    [[nodiscard]] double reach_px() const { return reach_px_; }
    [[nodiscard]] double anisotropy() const { return anisotropy_; }
    [[nodiscard]] double mean_candidates() const;

 private:
    void divide(int column, int row, int size, const std::vector<std::uint16_t>& candidates,
                std::vector<std::vector<std::uint16_t>>& cells) const;

    std::vector<Piece> pieces_;
    double reach_px_ = 0;
    double anisotropy_ = 1;
    double left_px_ = 0;
    double top_px_ = 0;
    double cells_per_px_ = 1;
    int columns_ = 0;
    int rows_ = 0;
    std::vector<std::uint32_t> first_;   // where each cell's list begins; one more at the end
    std::vector<std::uint16_t> listed_;  // the lists, rising
};

}  // namespace pursuit::tracker
