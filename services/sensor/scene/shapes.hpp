// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene.pb.h"
#include "services/sensor/scene/polygon.hpp"

namespace pursuit::sensor {

/// The polygons of a shape by name, front to back, about the layer's origin.
std::vector<PaintedPolygon> shape_polygons(const disk::SceneShape& shape);

}  // namespace pursuit::sensor
