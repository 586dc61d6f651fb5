// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/common/event.hpp"
#include "services/sensor/scene/active_pixels.hpp"
#include "services/sensor/scene/drawn_scene.hpp"
#include "services/sensor/scene/image_edges.hpp"
#include "services/sensor/scene/layer_looks.hpp"
#include "services/sensor/scene/look_plan.hpp"
#include "services/sensor/scene/look_spacing.hpp"
#include "services/sensor/scene/pixel_array.hpp"
#include "services/sensor/scene/scene_steps.hpp"
#include "services/sensor/scene/truth.hpp"

namespace pursuit::sensor {

/// Makes the events of a scene, slice by slice, for as long as wanted.
///
/// Time goes in steps within which nothing moves by more than SceneSensor.max_step_px (SceneSteps).
/// In each step the pixels near moving edges (ActivePixels) look at their exact, antialiased
/// brightness (ImageEdges) and fire (PixelArray); the others see no change. Layers and pixels that
/// can do so without an event in between look less often (LayerLooks, LookPlan, LookSpacing). When
/// a layer comes or goes every pixel looks.
///
/// The same scene and seed give the same events, however they are cut into slices. Memory is
/// bounded by the size of the pixel array, the length of the contours in it, and the events of one
/// slice. Not for use by several threads at once.
class SceneSimulator {
 public:
    SceneSimulator(const Scene& scene, std::uint64_t seed);

    Geometry geometry() const { return drawn_.geometry; }

    /// None: it never ends.
    std::optional<std::int64_t> duration_us() const { return duration_us_; }

    /// Whether the scene's sensor measures exposures.
    bool has_exposures() const { return pixels_->has_exposures(); }

    /// Appends the events of the next `slice_us` (at least 1) in order: by time, then row, column;
    /// and the exposure measurements, where they are wanted. False: the scene had already ended,
    /// nothing was appended.
    bool next(std::int64_t slice_us, std::vector<Event>& events,
              std::vector<Event>* exposures = nullptr);

    /// Every event before this time has been handed out.
    std::int64_t time_us() const { return time_us_; }

    /// What is tracked, in the order of the layers; its start pose is that of time 0.
    const std::vector<SceneModel>& models() const { return models_; }

    /// Where every tracked object is, for sensor time `t_us`.
    std::vector<TruthRow> truth(std::int64_t t_us) const;

    /// What the seed has made of the scene.
    const DrawnScene& drawn() const { return drawn_; }

 private:
    void step();
    void come_and_go();
    bool mark_needed();
    void mark();
    void look(bool marked);

    DrawnScene drawn_;
    std::optional<std::int64_t> duration_us_;
    std::vector<SceneModel> models_;
    SceneSteps steps_;
    ImageEdges edges_;
    ActivePixels active_;
    std::optional<PixelArray> pixels_;
    LayerLooks looks_;
    LookPlan plan_;
    LookSpacing spacing_;

    std::vector<LayerMotion> motions_;  // by layer, until the next mark()
    std::vector<PlanarMap> marked_;     // by layer: where it was at the last mark()
    std::int64_t mark_until_us_ = 0;    // when the active pixels are found anew at the latest
    double moved_px_ = 0;               // the furthest of any layer since mark()
    std::int64_t time_us_ = 0;
    std::vector<Event> pending_;  // not yet handed out, not in order
    std::vector<Event> unwanted_;
};

}  // namespace pursuit::sensor
