// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/image_edges.hpp"

#include <algorithm>

namespace pursuit::sensor {

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

float ImageEdges::coverage(const ImagePolygon& polygon, std::span<const std::uint32_t> near,
                           float x, float y) const {
    float sum = 0;
    int inside_count = 0;
    bool foot_on_edge = false;
    for (const auto e : near) {
        const ImageEdge& edge = edges_[e];
        const float dx = x - edge.ax;
        const float dy = y - edge.ay;
        const float h = (edge.ux * dy - edge.uy * dx) * per_sigma_;
        const float along = (edge.ux * dx + edge.uy * dy) * per_sigma_;
        const float rest = edge.length * per_sigma_ - along;
        const float distance = std::abs(h);
        inside_count += h > 0 ? 1 : 0;
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
