// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/tracker/core/candidate_grid.hpp"
#include "services/tracker/core/pose.hpp"
#include "services/tracker/core/shape.hpp"

namespace pursuit::tracker {

/// A shape ready for lookups: its points, its contour as straight pieces, and numbers about them.
/// Where the shape has no edges, they are inferred from the points: neighbours to which no third
/// point is nearer (the relative neighbourhood graph), unless far apart. Points that no edge
/// touches stay as pieces without length.
class Contour {
 public:
    Contour() = default;
    explicit Contour(const Shape& shape);

    /// Makes lookups good for places within reach_px (image) of the shape under A. Builds anew only
    /// when A has become more unequal or smaller than what was built for; the answers are exact
    /// either way.
    void fit(const Eigen::Matrix2d& a, double reach_px);

    [[nodiscard]] const CandidateGrid& points() const { return points_; }
    [[nodiscard]] const CandidateGrid& pieces() const { return pieces_; }

    /// Whether the shape came with closed outlines; edges out of a recording run anyhow.
    [[nodiscard]] bool is_outline() const { return is_outline_; }
    [[nodiscard]] double length_px() const { return length_px_; }      ///< Of all pieces, model px.
    [[nodiscard]] double gyration_px() const { return gyration_px_; }  ///< Radius of gyration.
    [[nodiscard]] double radius_px() const { return radius_px_; }      ///< Of the farthest point.

 private:
    bool is_outline_ = false;
    double length_px_ = 0;
    double gyration_px_ = 0;
    double radius_px_ = 0;
    CandidateGrid points_;
    CandidateGrid pieces_;
};

/// The edges that a contour without edges gets.
std::vector<Edge> inferred_edges(const std::vector<Eigen::Vector2f>& points_px);

}  // namespace pursuit::tracker
