// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/geometry/contour_edges.hpp"

#include <algorithm>
#include <cstddef>
#include <nanoflann.hpp>
#include <set>
#include <utility>

namespace pursuit::tracker {
namespace {

// An inferred edge is at most this many times the median distance between neighbours.
constexpr float longest_edge = 2.5F;

// Of the shape's radius: points that are nearer to each other are one.
constexpr float same_place = 1e-4F;

using Points = Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor>;
using Tree = nanoflann::KDTreeEigenMatrixAdaptor<Points, 2, nanoflann::metric_L2_Simple>;
using Found = std::vector<std::pair<Eigen::Index, float>>;

Points matrix_of(const std::vector<Eigen::Vector2f>& points_px) {
    Points matrix(static_cast<Eigen::Index>(points_px.size()), 2);
    for (std::size_t i = 0; i < points_px.size(); ++i) {
        matrix.row(static_cast<Eigen::Index>(i)) = points_px[i].transpose();
    }
    return matrix;
}

}  // namespace

Shape without_repeats(const Shape& shape) {
    Shape kept{shape.name, {}, {}};
    const std::vector<Eigen::Vector2f>& points_px = shape.points_px;
    float radius2 = 0;
    for (const Eigen::Vector2f& point : points_px) radius2 = std::max(radius2, point.squaredNorm());
    const Points matrix = matrix_of(points_px);
    const Tree tree(2, std::cref(matrix));
    const nanoflann::SearchParams sorted;
    constexpr std::size_t none = ~std::size_t{0};
    std::vector<std::size_t> place(points_px.size(), none);
    Found near;
    for (std::size_t i = 0; i < points_px.size(); ++i) {
        if (place[i] != none) continue;
        tree.index->radiusSearch(points_px[i].data(), same_place * same_place * radius2, near,
                                 sorted);
        place[i] = kept.points_px.size();
        for (const auto& [other, squared] : near) {
            const auto j = static_cast<std::size_t>(other);
            if (place[j] == none) place[j] = kept.points_px.size();
        }
        kept.points_px.push_back(points_px[i]);
    }
    std::set<std::pair<std::uint16_t, std::uint16_t>> joined;
    for (const Edge& edge : shape.edges) {
        const Edge moved{static_cast<std::uint16_t>(place[edge.from]),
                         static_cast<std::uint16_t>(place[edge.to])};
        if (moved.from == moved.to) continue;
        if (joined.insert(std::minmax(moved.from, moved.to)).second) kept.edges.push_back(moved);
    }
    return kept;
}

std::vector<Edge> inferred_edges(const std::vector<Eigen::Vector2f>& points_px) {
    const std::size_t count = points_px.size();
    std::vector<Edge> edges;
    if (count < 2) return edges;
    const Points matrix = matrix_of(points_px);
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
    const float longest2 =
        longest_edge * longest_edge * std::max(to_neighbour2[to_neighbour2.size() / 2], 1e-4F);
    const nanoflann::SearchParams sorted;
    Found near;
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

}  // namespace pursuit::tracker
