// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/contour_model.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::sensor {
namespace {

/// Moves the points' origin to their centre of gravity.
void centre(ContourModel& model) {
    Point mean = Point::Zero();
    for (const Point& p : model.points) mean += p;
    mean /= static_cast<double>(std::max<std::size_t>(model.points.size(), 1));
    for (Point& p : model.points) p -= mean;
    model.centre += mean;
}

}  // namespace

ContourModel contour_model(const std::vector<PaintedPolygon>& polygons, std::uint32_t count) {
    double length_px = 0;
    for (const auto& polygon : polygons) {
        if (!polygon.contour) continue;
        for (std::size_t i = 0; i < polygon.vertices.size(); ++i) {
            const Point& next = polygon.vertices[(i + 1) % polygon.vertices.size()];
            length_px += (next - polygon.vertices[i]).norm();
        }
    }
    const double spacing_px = length_px / count;

    ContourModel model;
    for (const auto& polygon : polygons) {
        if (!polygon.contour) continue;
        const auto first = static_cast<std::uint32_t>(model.points.size());
        for (std::size_t i = 0; i < polygon.vertices.size(); ++i) {
            const Point& from = polygon.vertices[i];
            const Point way = polygon.vertices[(i + 1) % polygon.vertices.size()] - from;
            const auto pieces =
                static_cast<int>(std::max(1L, std::lround(way.norm() / spacing_px)));
            for (int k = 0; k < pieces; ++k) {
                model.points.push_back(from + way * (static_cast<double>(k) / pieces));
            }
        }
        const auto end = static_cast<std::uint32_t>(model.points.size());
        for (std::uint32_t i = first; i < end; ++i) {
            model.edges.emplace_back(i, i + 1 == end ? first : i + 1);
        }
    }
    centre(model);
    return model;
}

ContourModel clicked(const ContourModel& model, double sigma_px, Random& random) {
    ContourModel noisy = model;
    for (Point& p : noisy.points) {
        p.x() += sigma_px * random.normal();
        p.y() += sigma_px * random.normal();
    }
    centre(noisy);
    return noisy;
}

}  // namespace pursuit::sensor
