// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "services/tracker/core/geometry/candidate_grid.hpp"
#include "services/tracker/core/geometry/pose.hpp"
#include "services/tracker/core/geometry/shape.hpp"

namespace pursuit::tracker {

/// A shape ready for lookups: its points, its contour as straight pieces, and numbers about them.
/// Points that lie on each other are one (without_repeats()); where the shape has no edges, they
/// are inferred from the points (inferred_edges()). Points that no edge touches stay as pieces
/// without length.
class Contour {
 public:
    Contour() = default;
    explicit Contour(const Shape& given);

    /// Makes lookups of pieces good for places within reach_px (image) of the shape under A. Builds
    /// anew only when A has become more unequal or smaller than what was built for; the answers are
    /// exact either way.
    void fit(const Eigen::Matrix2d& a, double reach_px) { fit(pieces_, a, reach_px); }
    /// The same for lookups of points.
    void fit_points(const Eigen::Matrix2d& a, double reach_px) { fit(points_, a, reach_px); }

    /// Where A needs far less than lookups are good for, they are built anew by the next fit():
    /// what finds the nearest under scales that differ much, or in a tiny image of the shape, is
    /// slow.
    void forget_excess(const Eigen::Matrix2d& a, double reach_px);

    [[nodiscard]] const CandidateGrid& points() const { return points_; }
    [[nodiscard]] const CandidateGrid& pieces() const { return pieces_; }
    /// The pieces that end at this point, one at least.
    [[nodiscard]] std::span<const std::uint16_t> pieces_at(std::int32_t point) const {
        const auto i = static_cast<std::size_t>(point);
        return {&ending_[ending_from_[i]], ending_from_[i + 1] - ending_from_[i]};
    }

    /// Whether the shape came with closed outlines; edges out of a recording run anyhow.
    [[nodiscard]] bool is_outline() const { return is_outline_; }
    /// Whether it came with edges that leave points out or ends loose: told by the events of a
    /// recording, and so lying where events come from.
    [[nodiscard]] bool is_of_events() const { return is_of_events_; }
    [[nodiscard]] double length_px() const { return length_px_; }      ///< Of all pieces, model px.
    [[nodiscard]] double gyration_px() const { return gyration_px_; }  ///< Radius of gyration.
    [[nodiscard]] double radius_px() const { return radius_px_; }      ///< Of the farthest point.

 private:
    static void fit(CandidateGrid& grid, const Eigen::Matrix2d& a, double reach_px) {
        if (!is_fit(grid, a, reach_px)) build_for(grid, a, reach_px);
    }
    /// Without a root or a quotient: this is asked with every event. May deny it where the grid has
    /// little to spare.
    static bool is_fit(const CandidateGrid& grid, const Eigen::Matrix2d& a, double reach_px) {
        // Of the singular values: squares of their sum and difference.
        const double norm2 = a.squaredNorm();
        const double determinant2 = 2 * std::abs(a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0));
        const double sum2 = norm2 + determinant2;
        const double difference2 = norm2 - determinant2;
        const double larger = grid.anisotropy() + 1;
        const double smaller = grid.anisotropy() - 1;
        // σ_max/σ_min ≤ κ, and then σ_min ≥ sum/(κ + 1), which has to be reach_px/reach at least.
        const double needed = larger * reach_px;
        return difference2 * larger * larger <= smaller * smaller * sum2 &&
               needed * needed <= grid.reach_px() * grid.reach_px() * sum2;
    }
    static void build_for(CandidateGrid& grid, const Eigen::Matrix2d& a, double reach_px);

    bool is_outline_ = false;
    bool is_of_events_ = false;
    double length_px_ = 0;
    double gyration_px_ = 0;
    double radius_px_ = 0;
    CandidateGrid points_;
    CandidateGrid pieces_;
    std::vector<std::uint32_t> ending_from_;  // of each point, where its pieces begin
    std::vector<std::uint16_t> ending_;
};

}  // namespace pursuit::tracker
