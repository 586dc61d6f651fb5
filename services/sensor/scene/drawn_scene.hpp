// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/common/event.hpp"
#include "services/sensor/scene/contour_model.hpp"
#include "services/sensor/scene/polygon.hpp"
#include "services/sensor/scene/scene.hpp"
#include "services/sensor/scene/trajectory.hpp"

namespace pursuit::sensor {

/// A tracked layer's name and shape.
struct TrackedShape {
    std::string name;
    std::uint32_t object_id = 0;  ///< From 1, in the order of the scene's layers.
    disk::SceneLayer::Transform transform = disk::SceneLayer::ISOMETRY;
    bool search = false;  ///< No start pose is given.
    ContourModel model;
};

struct DrawnLayer {
    std::vector<PaintedPolygon> polygons;  ///< Front to back.
    Trajectory trajectory;
    double camera_share = 1;
    std::int64_t from_us = 0;        ///< It is there from here …
    std::int64_t to_us = INT64_MAX;  ///< … to before here.
    std::optional<TrackedShape> tracked;

    bool there(std::int64_t t_us) const { return t_us >= from_us && t_us < to_us; }
    bool comes_or_goes() const { return from_us > 0 || to_us < INT64_MAX; }
};

/// A scene with everything settled that its seed decides, apart from the pixels themselves.
struct DrawnScene {
    Geometry geometry;
    disk::SceneSensor sensor;
    double background_reflectance = 0.5;
    std::vector<DrawnLayer> layers;  ///< Front to back.
    Trajectory camera;
};

DrawnScene draw_scene(const Scene& scene, std::uint64_t seed);

/// image_from_layer at `t_s`.
PlanarMap image_from_layer(const DrawnScene& scene, const DrawnLayer& layer, double t_s);

}  // namespace pursuit::sensor
