// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/extraction/contour_links.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "services/ctl/extraction/event_cells.hpp"

namespace pursuit::ctl {
namespace {

constexpr float longest_link_px = 8;
constexpr float sigma_px = 0.8F;
constexpr float least_density = 0.2F;  // between two points, of the mean of theirs
constexpr float least_along = 0.75F;   // cosine between an edge's direction and a link
constexpr float clear_direction = 3;   // ratio of the cloud's axes, squared lengths

/// What the events around a point look like.
struct Surroundings {
    Eigen::Vector2f direction = Eigen::Vector2f::Zero();  ///< Zero where there is none.
    float density = 0;
};

float density_at(const EventCells& cells, const Eigen::Vector2f& at) {
    float density = 0;
    cells.each_around(at, 2, [&](const Eigen::Vector2f& event) {
        density += std::exp(-(event - at).squaredNorm() / (2 * sigma_px * sigma_px));
    });
    return density;
}

Surroundings look_around(const EventCells& cells, const Eigen::Vector2f& at) {
    Eigen::Vector2f mean = Eigen::Vector2f::Zero();
    Eigen::Matrix2f square = Eigen::Matrix2f::Zero();
    float count = 0;
    cells.each_around(at, 2, [&](const Eigen::Vector2f& event) {
        const Eigen::Vector2f from = event - at;
        mean += from;
        square += from * from.transpose();
        count += 1;
    });
    Surroundings found;
    found.density = density_at(cells, at);
    if (count < 3) return found;
    mean /= count;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f> axes;
    axes.computeDirect(square / count - mean * mean.transpose());
    if (axes.eigenvalues()(1) > clear_direction * axes.eigenvalues()(0)) {
        found.direction = axes.eigenvectors().col(1);
    }
    return found;
}

bool has_nearer_third(std::span<const Eigen::Vector2f> points_px, std::size_t i, std::size_t j) {
    const float bound = (points_px[i] - points_px[j]).squaredNorm();
    return std::any_of(points_px.begin(), points_px.end(), [&](const Eigen::Vector2f& third) {
        return (third - points_px[i]).squaredNorm() < bound &&
               (third - points_px[j]).squaredNorm() < bound;
    });
}

}  // namespace

std::vector<tracker::Edge> contour_links(std::span<const Eigen::Vector2f> points_px,
                                         std::span<const Eigen::Vector2f> events_px) {
    std::vector<tracker::Edge> links;
    if (events_px.empty()) return links;
    const EventCells cells(events_px);
    std::vector<Surroundings> around;
    for (const auto& point : points_px) around.push_back(look_around(cells, point));
    for (std::size_t i = 0; i < points_px.size(); ++i) {
        for (std::size_t j = i + 1; j < points_px.size(); ++j) {
            const Eigen::Vector2f link = points_px[j] - points_px[i];
            const float length_px = link.norm();
            if (length_px > longest_link_px || length_px == 0) continue;
            const auto runs_along = [&](std::size_t k) {
                const auto& direction = around[k].direction;
                return std::abs(direction.dot(link)) >= least_along * length_px;
            };
            if (!runs_along(i) || !runs_along(j)) continue;
            const float between = density_at(cells, (points_px[i] + points_px[j]) / 2);
            if (between < least_density * (around[i].density + around[j].density) / 2) continue;
            if (has_nearer_third(points_px, i, j)) continue;
            if (links.size() == tracker::max_shape_edges) return links;
            links.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j)});
        }
    }
    return links;
}

}  // namespace pursuit::ctl
