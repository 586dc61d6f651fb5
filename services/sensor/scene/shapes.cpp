// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/shapes.hpp"

#include <cmath>
#include <numbers>

namespace pursuit::sensor {
namespace {

using Outline = std::vector<Point>;

constexpr double pi = std::numbers::pi;

/// Corners alternate between the outer and the inner radius; one arm points up.
Outline star() {
    constexpr double inner_radius = 0.43;
    Outline outline;
    for (int i = 0; i < 10; ++i) {
        const double radius = i % 2 == 0 ? 1.0 : inner_radius;
        outline.emplace_back(radius * std::sin(pi * i / 5), -radius * std::cos(pi * i / 5));
    }
    return outline;
}

Outline arrow() {
    return {{1, 0},      {0.12, 0.6},   {0.12, 0.18}, {-1, 0.18},
            {-1, -0.18}, {0.12, -0.18}, {0.12, -0.5}};
}

/// The letter's outline and, in front of it, its hole.
std::vector<Outline> letter_p() {
    return {{{-0.22, -0.72}, {0.28, -0.72}, {0.28, -0.2}, {-0.22, -0.2}},
            {{-0.6, -1},
             {0.28, -1},
             {0.62, -0.72},
             {0.62, -0.16},
             {0.28, 0.08},
             {-0.22, 0.08},
             {-0.22, 1},
             {-0.6, 1}}};
}

Outline letter_h() {
    return {{-0.8, -1}, {-0.28, -1}, {-0.28, -0.14}, {0.28, -0.14}, {0.28, -1}, {0.8, -1},
            {0.8, 1},   {0.28, 1},   {0.28, 0.14},   {-0.28, 0.14}, {-0.28, 1}, {-0.8, 1}};
}

/// Side views of unit length, nose to +x: windows, then the body.
std::vector<Outline> car() {
    return {{{-0.245, -0.035}, {-0.17, -0.165}, {-0.04, -0.165}, {-0.04, -0.035}},
            {{0.02, -0.035}, {0.02, -0.165}, {0.11, -0.165}, {0.21, -0.035}},
            {{-0.5, -0.01},
             {-0.35, -0.03},
             {-0.2, -0.215},
             {0.15, -0.215},
             {0.3, -0.02},
             {0.46, 0.03},
             {0.5, 0.06},
             {0.5, 0.205},
             {-0.5, 0.205}}};
}

std::vector<Outline> van() {
    return {
        {{0.15, -0.16}, {0.235, -0.16}, {0.35, -0.03}, {0.15, -0.03}},
        {{-0.4, -0.15}, {0.05, -0.15}, {0.05, -0.025}, {-0.4, -0.025}},
        {{-0.5, -0.225}, {0.245, -0.225}, {0.415, -0.03}, {0.5, 0.03}, {0.5, 0.24}, {-0.5, 0.24}}};
}

Outline rectangle(double aspect) {
    return {{-0.5, -0.5 * aspect}, {0.5, -0.5 * aspect}, {0.5, 0.5 * aspect}, {-0.5, 0.5 * aspect}};
}

Outline ellipse(double aspect) {
    constexpr int corners = 24;
    Outline outline;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * pi * i / corners;
        outline.emplace_back(0.5 * std::cos(angle), 0.5 * aspect * std::sin(angle));
    }
    return outline;
}

std::vector<Outline> unit_outlines(const disk::SceneShape& shape) {
    switch (shape.kind()) {
        case disk::SceneShape::STAR:
            return {star()};
        case disk::SceneShape::ARROW:
            return {arrow()};
        case disk::SceneShape::LETTER_P:
            return letter_p();
        case disk::SceneShape::LETTER_H:
            return {letter_h()};
        case disk::SceneShape::CAR:
            return car();
        case disk::SceneShape::VAN:
            return van();
        case disk::SceneShape::RECTANGLE:
            return {rectangle(shape.aspect())};
        case disk::SceneShape::ELLIPSE:
            return {ellipse(shape.aspect())};
    }
    return {};
}

}  // namespace

std::vector<PaintedPolygon> shape_polygons(const disk::SceneShape& shape) {
    std::vector<PaintedPolygon> polygons;
    const auto outlines = unit_outlines(shape);
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        PaintedPolygon polygon;
        for (const Point& p : outlines[i]) {
            polygon.vertices.emplace_back(shape.size_px() * (shape.mirrored() ? -p.x() : p.x()),
                                          shape.size_px() * p.y());
        }
        orient(polygon.vertices);
        const bool body = i + 1 == outlines.size();
        polygon.reflectance = body ? shape.reflectance() : shape.window_reflectance();
        polygons.push_back(std::move(polygon));
    }
    return polygons;
}

}  // namespace pursuit::sensor
