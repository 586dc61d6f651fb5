// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/sensor/scene/planar_map.hpp"

namespace pursuit::sensor {

/// A closed polygon of one brightness, in its layer's frame. Oriented so that for an edge a -> b
/// the inside lies where cross(b - a, p - a) > 0.
struct PaintedPolygon {
    std::vector<Point> vertices;
    double reflectance = 0.2;
    bool contour = true;  ///< Its outline belongs to the model of the layer.
};

/// Twice the enclosed area, positive in the orientation above.
double doubled_area(const std::vector<Point>& vertices);

/// Turns the vertices into the orientation above.
void orient(std::vector<Point>& vertices);

/// What is wrong with a polygon: fewer than 3 vertices, no area, an edge without length, edges that
/// cross or touch. O(n²).
std::optional<std::string> polygon_error(const std::vector<Point>& vertices);

/// Whether `p` is inside, by counting crossings of the ray to the left.
bool contains(const std::vector<Point>& vertices, const Point& p);

}  // namespace pursuit::sensor
