// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/contour.hpp"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

namespace pursuit::tracker {
namespace {

// An inferred edge is at most this many times the median distance between neighbours.
constexpr double longest_edge = 2.5;

// The grid is built for somewhat more than asked, so that it is not built again at once.
constexpr double spare = 1.25;
// Equal scales need no room for unequal ones, but for what rounding makes of them.
constexpr double equal_scales = 1 + 1e-6;

// Cells are a part of a piece long, so that they list one or two; px of the model frame.
constexpr double cells_of_piece = 0.4;
constexpr double finest_cells_px = 0.25;
constexpr double coarsest_cells_px = 1.5;

using Points = Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor>;
using Tree = nanoflann::KDTreeEigenMatrixAdaptor<Points, 2, nanoflann::metric_L2_Simple>;

}  // namespace

std::vector<Edge> inferred_edges(const std::vector<Eigen::Vector2f>& points_px) {
    const std::size_t count = points_px.size();
    std::vector<Edge> edges;
    if (count < 2) return edges;
    Points matrix(static_cast<Eigen::Index>(count), 2);
    for (std::size_t i = 0; i < count; ++i) {
        matrix.row(static_cast<Eigen::Index>(i)) = points_px[i].transpose();
    }
    const Tree tree(2, std::cref(matrix));
    std::vector<float> to_neighbour2;
    for (const Eigen::Vector2f& point : points_px) {
        Eigen::Index index[2];
        float squared[2];
        if (tree.index->knnSearch(point.data(), 2, index, squared) == 2) {
            to_neighbour2.push_back(squared[1]);
        }
    }
    std::nth_element(to_neighbour2.begin(),
                     to_neighbour2.begin() + static_cast<std::ptrdiff_t>(to_neighbour2.size() / 2),
                     to_neighbour2.end());
    const auto longest2 = static_cast<float>(longest_edge * longest_edge) *
                          std::max(to_neighbour2[to_neighbour2.size() / 2], 1e-4F);
    const nanoflann::SearchParams sorted;
    std::vector<std::pair<Eigen::Index, float>> near;
    for (std::size_t i = 0; i < count; ++i) {
        tree.index->radiusSearch(points_px[i].data(), longest2, near, sorted);
        for (const auto& [other, squared] : near) {
            const auto j = static_cast<std::size_t>(other);
            if (j <= i) continue;
            const float bound = squared;
            const bool has_third = std::any_of(near.begin(), near.end(), [&](const auto& third) {
                const auto k = static_cast<std::size_t>(third.first);
                return k != i && k != j && third.second < bound &&
                       (points_px[k] - points_px[j]).squaredNorm() < bound;
            });
            if (has_third) continue;
            edges.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j)});
        }
    }
    return edges;
}

Contour::Contour(const Shape& shape) {
    std::vector<Piece> points;
    double sum2 = 0;
    for (const Eigen::Vector2f& point : shape.points_px) {
        const Eigen::Vector2d p = point.cast<double>();
        points.push_back({p.x(), p.y(), p.x(), p.y()});
        sum2 += p.squaredNorm();
        radius_px_ = std::max(radius_px_, p.norm());
    }
    gyration_px_ = std::sqrt(sum2 / static_cast<double>(points.size()));

    std::vector<int> touching(shape.points_px.size(), 0);
    for (const Edge& edge : shape.edges) {
        ++touching[edge.from];
        ++touching[edge.to];
    }
    is_outline_ = !shape.edges.empty() &&
                  std::all_of(touching.begin(), touching.end(), [](int n) { return n == 2; });
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
    const double norm2 = a.squaredNorm();
    const double determinant = std::abs(a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0));
    const double sum = std::sqrt(norm2 + 2 * determinant);
    const double difference = std::sqrt(std::max(0.0, norm2 - 2 * determinant));
    const double smallest = std::max((sum - difference) / 2, 1e-3);
    const double anisotropy = (sum + difference) / 2 / smallest;
    if (anisotropy <= grid.anisotropy() && reach_px / smallest <= grid.reach_px()) return;
    const double built_for = anisotropy <= grid.anisotropy() ? grid.anisotropy()
                             : anisotropy < equal_scales     ? equal_scales
                                                             : anisotropy * spare;
    grid.build(std::max(grid.reach_px(), reach_px / smallest * spare), built_for);
}

}  // namespace pursuit::tracker
