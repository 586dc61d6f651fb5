// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "services/sensor/scene/polygon.hpp"
#include "services/sensor/scene/random.hpp"

namespace pursuit::sensor {

/// Points along the contours of a shape, px about their centre of gravity, and the pieces of
/// contour between them.
struct ContourModel {
    std::vector<Point> points;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    Point centre = Point::Zero();  ///< The centre of gravity in the layer's frame.
};

/// About `count` points evenly spread over the outlines that are contours; every corner is one.
ContourModel contour_model(const std::vector<PaintedPolygon>& polygons, std::uint32_t count);

/// The same as a hand would click it: each coordinate off by a normal error of `sigma_px`, about
/// the centre of gravity of the clicked points.
ContourModel clicked(const ContourModel& model, double sigma_px, Random& random);

}  // namespace pursuit::sensor
