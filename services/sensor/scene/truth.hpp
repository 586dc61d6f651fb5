// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/sensor/scene/drawn_scene.hpp"

namespace pursuit::sensor {

/// Where a tracked object is: image_from_model, p = (x_px, y_px) + A m. Under perspective A is the
/// affine map nearest to the view at the model's points.
struct TruthRow {
    std::int64_t t_us = 0;
    std::uint32_t object_id = 0;
    std::string model;
    double x_px = 0;
    double y_px = 0;
    double a00 = 1;
    double a01 = 0;
    double a10 = 0;
    double a11 = 1;
    double theta_rad = 0;  ///< Rotation of A's polar decomposition.
    double scale_x = 1;    ///< Along the model's own axes: lengths of A's columns.
    double scale_y = 1;
    double visible_fraction = 0;  ///< Of its points: inside the image, under no layer in front.
    double fit_px = 0;            ///< rms over its points: how far the view is from that A.
};

/// A tracked shape as it is given to a tracker.
struct SceneModel {
    std::string name;
    std::uint32_t object_id = 0;
    disk::SceneLayer::Transform transform = disk::SceneLayer::ISOMETRY;
    ContourModel model;       ///< With the scene's click errors.
    ContourModel true_model;  ///< Without; equal where there are none.
    bool search = false;      ///< No start pose is given.
    TruthRow start;           ///< Pose at time 0 with an error.
    double error_x_px = 0;    ///< start - truth.
    double error_y_px = 0;
    double error_theta_rad = 0;
    double error_scale = 0;
};

/// One row for each tracked layer, for sensor time `t_us`. Events come `latency_us` after what they
/// show, which nobody can see from them: truth of t is the pose at t - latency_us.
std::vector<TruthRow> truth_at(const DrawnScene& scene, std::int64_t t_us);

/// Models with click errors, and start poses with errors, as the scene states them.
std::vector<SceneModel> draw_models(const Scene& scene, const DrawnScene& drawn,
                                    std::uint64_t seed);

}  // namespace pursuit::sensor
