// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/sensor/scene/drawn_scene.hpp"
#include "services/sensor/scene/planar_map.hpp"

namespace pursuit::sensor {

/// image_from_layer at `t_us`; of a layer that is not there, one that takes it far out of the
/// image.
PlanarMap place_of(const DrawnScene& scene, const DrawnLayer& layer, std::int64_t t_us);

/// The time of a scene, in steps within which nothing in the image moves by more than
/// SceneSensor.max_step_px (and 5 %), and where its layers are. A step ends where a layer comes or
/// goes. Threads: one.
class SceneSteps {
 public:
    /// Where a layer is: image_from_layer, as place_of() has it.
    struct Layer {
        bool fixed = false;  ///< Never moves, comes or goes.
        PlanarMap before;    ///< One step ago.
        PlanarMap now;
        double step_px = 0;          ///< How far it moved in between; 0 where it came or went.
        PlanarMap next;              ///< Where advance() tries it.
        std::vector<Point> corners;  ///< Of its bounding box, layer frame.
    };

    /// At time 0. Each call is given the same scene.
    explicit SceneSteps(const DrawnScene& scene);

    /// One step further.
    void advance(const DrawnScene& scene);

    std::int64_t now_us() const { return now_us_; }

    /// The length of the last step.
    std::int64_t step_us() const { return step_us_; }

    /// Whether a layer comes or goes now.
    bool comes_or_goes() const { return comes_or_goes_; }

    /// In the order of the scene's.
    const std::vector<Layer>& layers() const { return layers_; }

    /// How far anything of the layer that is in the image moves between two maps: at most as far as
    /// the corners of its bounding box, and as what is at the corners of the image.
    double displacement_px(const Layer& layer, const PlanarMap& a, const PlanarMap& b) const;

 private:
    std::int64_t next_change_us() const;
    std::int64_t place_next(const DrawnScene& scene);

    Geometry geometry_;
    double max_step_px_;
    std::vector<Layer> layers_;
    std::vector<std::int64_t> changes_us_;  // when layers come or go, ascending, each once
    std::size_t next_change_ = 0;
    std::int64_t now_us_ = 0;
    std::int64_t step_us_ = 1;
    bool comes_or_goes_ = false;
};

}  // namespace pursuit::sensor
