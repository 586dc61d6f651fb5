// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/geometry/contour.hpp"

#include <algorithm>
#include <cmath>

#include "services/tracker/core/geometry/contour_edges.hpp"

namespace pursuit::tracker {
namespace {

// The grid is built for somewhat more than asked, so that it is not built again at once.
constexpr double spare = 1.25;
// What was built for more than so many times of what is needed has had its time. (Acquisitions go
// up to twice as unequal as they begin, and their gates differ by eight.)
constexpr double excess_anisotropy = 4;
constexpr double excess_reach = 32;
// Equal scales need no room for unequal ones, but for what rounding makes of them.
constexpr double equal_scales = 1 + 1e-6;

// Cells are a part of a piece long, so that they list one or two; px of the model frame.
constexpr double cells_of_piece = 0.4;
constexpr double finest_cells_px = 0.25;
constexpr double coarsest_cells_px = 1.5;

struct Need {
    double anisotropy;
    double reach_px;  // model frame
};

Need need_of(const Eigen::Matrix2d& a, double reach_px) {
    const double norm2 = a.squaredNorm();
    const double determinant = std::abs(a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0));
    const double sum = std::sqrt(norm2 + 2 * determinant);
    const double difference = std::sqrt(std::max(0.0, norm2 - 2 * determinant));
    const double smallest = std::max((sum - difference) / 2, 1e-3);
    return {(sum + difference) / 2 / smallest, reach_px / smallest};
}

/// Whether each point is the end of two edges.
bool is_closed(const Shape& shape) {
    std::vector<int> touching(shape.points_px.size(), 0);
    for (const Edge& edge : shape.edges) {
        ++touching[edge.from];
        ++touching[edge.to];
    }
    return !shape.edges.empty() &&
           std::all_of(touching.begin(), touching.end(), [](int n) { return n == 2; });
}

}  // namespace

Contour::Contour(const Shape& given) {
    const Shape shape = without_repeats(given);
    std::vector<Piece> points;
    double sum2 = 0;
    for (const Eigen::Vector2f& point : shape.points_px) {
        const Eigen::Vector2d p = point.cast<double>();
        points.push_back({p.x(), p.y(), p.x(), p.y()});
        sum2 += p.squaredNorm();
        radius_px_ = std::max(radius_px_, p.norm());
    }
    gyration_px_ = std::sqrt(sum2 / static_cast<double>(points.size()));

    is_outline_ = is_closed(given) || is_closed(shape);
    is_of_events_ = !shape.edges.empty() && !is_outline_;
    const std::vector<Edge> edges =
        shape.edges.empty() ? inferred_edges(shape.points_px) : shape.edges;
    std::vector<Piece> pieces;
    std::vector<std::vector<std::uint16_t>> ending(points.size());
    for (const Edge& edge : edges) {
        const Piece& from = points[edge.from];
        const Piece& to = points[edge.to];
        ending[edge.from].push_back(static_cast<std::uint16_t>(pieces.size()));
        ending[edge.to].push_back(static_cast<std::uint16_t>(pieces.size()));
        pieces.push_back({from.ax, from.ay, to.ax, to.ay});
        length_px_ += std::hypot(to.ax - from.ax, to.ay - from.ay);
    }
    ending_from_.push_back(0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (ending[i].empty()) {
            ending[i].push_back(static_cast<std::uint16_t>(pieces.size()));
            pieces.push_back(points[i]);
        }
        ending_.insert(ending_.end(), ending[i].begin(), ending[i].end());
        ending_from_.push_back(static_cast<std::uint32_t>(ending_.size()));
    }
    const double finest_cell_px =
        std::clamp(cells_of_piece * length_px_ / static_cast<double>(pieces.size()),
                   finest_cells_px, coarsest_cells_px);
    points_ = CandidateGrid(std::move(points), finest_cell_px);
    pieces_ = CandidateGrid(std::move(pieces), finest_cell_px);
}

void Contour::build_for(CandidateGrid& grid, const Eigen::Matrix2d& a, double reach_px) {
    const Need need = need_of(a, reach_px);
    if (need.anisotropy <= grid.anisotropy() && need.reach_px <= grid.reach_px()) return;
    const double built_for = need.anisotropy <= grid.anisotropy() ? grid.anisotropy()
                             : need.anisotropy < equal_scales     ? equal_scales
                                                                  : need.anisotropy * spare;
    grid.build(std::max(grid.reach_px(), need.reach_px * spare), built_for);
}

void Contour::forget_excess(const Eigen::Matrix2d& a, double reach_px) {
    const Need need = need_of(a, reach_px);
    for (CandidateGrid* const grid : {&points_, &pieces_}) {
        if (grid->anisotropy() > excess_anisotropy * need.anisotropy ||
            grid->reach_px() > excess_reach * need.reach_px) {
            grid->forget();
        }
    }
}

}  // namespace pursuit::tracker
