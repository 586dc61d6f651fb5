// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/common/event.hpp"
#include "services/sensor/scene/active_pixels.hpp"
#include "services/sensor/scene/drawn_scene.hpp"
#include "services/sensor/scene/image_edges.hpp"
#include "services/sensor/scene/pixel_array.hpp"
#include "services/sensor/scene/truth.hpp"

namespace pursuit::sensor {

/// Makes the events of a scene, slice by slice, for as long as wanted.
///
/// Time goes in steps within which nothing moves by more than SceneSensor.max_step_px. In each step
/// the pixels near moving edges look at their exact, antialiased brightness; the others see no
/// change. A layer that moves slowly beside a fast one is looked at less often. When a layer comes
/// or goes every pixel looks.
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
    /// Pixels may be looked at every so many looks, where edges move along themselves.
    static constexpr std::uint32_t greatest_stride = 4;

    /// No pixel that is near something goes for more looks without one of its own.
    static constexpr std::uint32_t greatest_skip = 63;

    struct LayerState {
        LayerMotion motion = LayerMotion::fixed;
        std::vector<Point> corners;  // of its bounding box, layer frame
        PlanarMap before;            // one step ago
        PlanarMap now;
        PlanarMap next;
        PlanarMap looked;  // when its pixels were last looked at
        // When the last looks were, the newest first.
        std::array<std::int64_t, greatest_stride> looks_us{};
        bool looked_now = false;
        PlanarMap marked;  // at the last mark()
        double step_px = 0;
    };

    double displacement_px(const LayerState& layer, const PlanarMap& a, const PlanarMap& b) const;
    PlanarMap place_of(std::size_t layer, std::int64_t t_us) const;
    std::int64_t next_change_us() const;
    void step();
    void come_and_go();
    std::int64_t settled_us() const;
    std::int64_t place_next();
    bool mark_needed();
    void mark();
    void look(bool marked);
    void plan_looks();
    void plan_look(std::uint32_t active, std::uint64_t look);
    std::uint32_t looks_without_event(const ActivePixels::Pixel& pixel,
                                      const ActivePixels::Sight& sight, float unknown_sigmas) const;

    DrawnScene drawn_;
    std::optional<std::int64_t> duration_us_;
    std::vector<SceneModel> models_;
    ImageEdges edges_;
    ActivePixels active_;
    std::vector<LayerState> layers_;
    std::optional<PixelArray> pixels_;

    std::vector<std::int64_t> changes_us_;  // when layers come or go, ascending, each once
    std::size_t next_change_ = 0;
    std::int64_t now_us_ = 0;         // the last step
    std::int64_t step_us_ = 1;        // its length
    std::int64_t mark_until_us_ = 0;  // when the active pixels are found anew at the latest
    std::int64_t time_us_ = 0;
    std::uint64_t look_count_ = 0;
    double moved_px_ = 0;                   // the furthest of any layer since mark()
    std::vector<std::uint64_t> next_look_;  // by pixel: the look at which it looks again
    // The active pixels, by number, that look next at each of the looks to come, modulo.
    std::array<std::vector<std::uint32_t>, greatest_skip + 1> plan_;
    std::vector<std::uint32_t> looking_;
    std::vector<Event> pending_;  // not yet handed out, not in order
    std::vector<Event> unwanted_;
};

}  // namespace pursuit::sensor
