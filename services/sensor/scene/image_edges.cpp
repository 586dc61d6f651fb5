// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/image_edges.hpp"

#include <algorithm>

namespace pursuit::sensor {
namespace {

/// Nearer than this, in sigmas, a pixel counts as being on an edge; and where it looks from then,
/// beyond that distance for every blur (0.002 of the contrast away).
constexpr float on_edge = 1e-3F;
constexpr float aside_px = 6e-3F;

}  // namespace

ImageEdges::ImageEdges(const DrawnScene& scene, double sigma_px)
    : sigma_px_(sigma_px), per_sigma_(static_cast<float>(1 / sigma_px)) {
    for (std::size_t layer = 0; layer < scene.layers.size(); ++layer) {
        first_polygon_.push_back(static_cast<std::uint32_t>(polygons_.size()));
        for (const auto& painted : scene.layers[layer].polygons) {
            const auto& v = painted.vertices;
            const auto first = static_cast<std::uint32_t>(layer_vertices_.size());
            const auto count = static_cast<std::uint32_t>(v.size());
            for (std::uint32_t i = 0; i < count; ++i) {
                const Point way = v[(i + 1) % count] - v[i];
                const Point next = v[(i + 2) % count] - v[(i + 1) % count];
                layer_vertices_.push_back(v[i]);
                convex_end_.push_back(way.x() * next.y() - way.y() * next.x() > 0);
                polygon_of_.push_back(static_cast<std::uint32_t>(polygons_.size()));
            }
            polygons_.push_back({static_cast<std::uint32_t>(layer), first, count,
                                 static_cast<float>(painted.reflectance)});
        }
    }
    first_polygon_.push_back(static_cast<std::uint32_t>(polygons_.size()));
    edges_.resize(layer_vertices_.size());
    normal_share_.assign(layer_vertices_.size(), 1);
}

void ImageEdges::place(std::size_t layer, const PlanarMap& image_from_layer) {
    for (auto k = first_polygon_[layer]; k < first_polygon_[layer + 1]; ++k) {
        ImagePolygon& polygon = polygons_[k];
        const Point first = image_from_layer * layer_vertices_[polygon.first_edge];
        Point a = first;
        Point low = first;
        Point high = first;
        for (std::uint32_t i = 0; i < polygon.edge_count; ++i) {
            const auto e = polygon.first_edge + i;
            const Point b =
                i + 1 == polygon.edge_count ? first : image_from_layer * layer_vertices_[e + 1];
            const Point way = b - a;
            const double length = way.norm();
            const Point u = way / std::max(length, 1e-12);
            edges_[e] = {static_cast<float>(a.x()), static_cast<float>(a.y()),
                         static_cast<float>(u.x()), static_cast<float>(u.y()),
                         static_cast<float>(length)};
            low = low.cwiseMin(b);
            high = high.cwiseMax(b);
            a = b;
        }
        polygon.x_low = static_cast<float>(low.x());
        polygon.y_low = static_cast<float>(low.y());
        polygon.x_high = static_cast<float>(high.x());
        polygon.y_high = static_cast<float>(high.y());
    }
}

void ImageEdges::note_motion(std::size_t layer, const PlanarMap& from, const PlanarMap& to,
                             double whole_px) {
    // The normals turn until the next note.
    constexpr double turning = 0.04;
    for (auto k = first_polygon_[layer]; k < first_polygon_[layer + 1]; ++k) {
        const ImagePolygon& polygon = polygons_[k];
        for (std::uint32_t i = 0; i < polygon.edge_count; ++i) {
            const auto e = polygon.first_edge + i;
            const Point& a = layer_vertices_[e];
            const Point& b =
                layer_vertices_[i + 1 == polygon.edge_count ? polygon.first_edge : e + 1];
            const Point normal(-edges_[e].uy, edges_[e].ux);
            const double moved = std::max(std::abs(normal.dot(to * a - from * a)),
                                          std::abs(normal.dot(to * b - from * b)));
            const double share = whole_px > 0 ? moved / whole_px : 1;
            normal_share_[e] = static_cast<float>(std::min(share + turning, 1.0));
        }
    }
}

float ImageEdges::coverage(const ImagePolygon& polygon, std::span<const std::uint32_t> near,
                           float x, float y, Nearness& nearness, bool may_step_aside) const {
    float sum = 0;
    int inside_count = 0;
    bool foot_on_edge = false;
    const ImageEdge* underfoot = nullptr;
    for (const auto e : near) {
        const ImageEdge& edge = edges_[e];
        const float dx = x - edge.ax;
        const float dy = y - edge.ay;
        const float h = (edge.ux * dy - edge.uy * dx) * per_sigma_;
        const float along = (edge.ux * dx + edge.uy * dy) * per_sigma_;
        const float rest = edge.length * per_sigma_ - along;
        const float distance = std::abs(h);
        const float away = std::max({distance, -along, -rest});
        nearness.sigmas = std::min(nearness.sigmas, away);
        nearness.count += away < cut_sigmas ? 1 : 0;
        inside_count += h > 0 ? 1 : 0;
        if (distance < on_edge && along > -on_edge && rest > -on_edge) underfoot = &edge;
        if (distance >= GaussianCoverage::reach) {
            foot_on_edge = along > 0 && rest > 0;
            continue;
        }
        float part = 0;
        if (along >= GaussianCoverage::reach && rest >= GaussianCoverage::reach) {
            part = gaussian_.tail(distance);
            foot_on_edge = true;
        } else {
            part = gaussian_.edge_part(distance, rest) + gaussian_.edge_part(distance, along);
            foot_on_edge = along > 0 && rest > 0;
        }
        sum += h > 0 ? part : -part;
    }
    if (underfoot != nullptr && near.size() > 1 && may_step_aside) {
        // Exactly on an edge among others rounding would decide between in and out: step aside.
        const float aside_x = aside_px * (0.4F * underfoot->ux - underfoot->uy);
        const float aside_y = aside_px * (0.4F * underfoot->uy + underfoot->ux);
        return coverage(polygon, near, x + aside_x, y + aside_y, nearness, false);
    }
    // Within reach there is nothing but the near edges, so that one or two neighbours alone tell
    // inside from outside; with more, count crossings.
    bool is_inside = false;
    const auto one_past = [&](std::uint32_t e) {
        return e + 1 == polygon.first_edge + polygon.edge_count ? polygon.first_edge : e + 1;
    };
    if (near.size() == 1 && foot_on_edge) {
        is_inside = inside_count == 1;
    } else if (near.size() == 2 && one_past(near[0]) == near[1]) {
        is_inside = inside_count == 2 || (inside_count == 1 && convex_end_[near[0]] == 0);
    } else if (near.size() == 2 && one_past(near[1]) == near[0]) {
        is_inside = inside_count == 2 || (inside_count == 1 && convex_end_[near[1]] == 0);
    } else {
        is_inside = inside(polygon, x, y);
    }
    return std::clamp((is_inside ? 1.0F : 0.0F) - sum, 0.0F, 1.0F);
}

bool ImageEdges::inside(const ImagePolygon& polygon, float x, float y) const {
    bool result = false;
    const ImageEdge* edge = &edges_[polygon.first_edge];
    float by = edge[polygon.edge_count - 1].ay;
    float bx = edge[polygon.edge_count - 1].ax;
    for (std::uint32_t i = 0; i < polygon.edge_count; ++i) {
        const float ay = edge[i].ay;
        const float ax = edge[i].ax;
        if ((ay > y) != (by > y) && x < ax + (bx - ax) * (y - ay) / (by - ay)) result = !result;
        bx = ax;
        by = ay;
    }
    return result;
}

}  // namespace pursuit::sensor
