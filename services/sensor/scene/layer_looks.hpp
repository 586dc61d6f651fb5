// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/sensor/scene/active_pixels.hpp"
#include "services/sensor/scene/look_spacing.hpp"
#include "services/sensor/scene/scene_steps.hpp"

namespace pursuit::sensor {

/// When the pixels near each layer look at it: as often as it moves by max_step_px, so that a layer
/// that moves slowly beside a fast one is looked at less often. Threads: one.
class LayerLooks {
 public:
    /// All have just been looked at.
    LayerLooks(const SceneSteps& steps, double max_step_px);

    /// The layers that are looked at now, bit (layer mod 64) each. all: every one that has moved
    /// since its last look; otherwise those that the next step might take too far, or that went
    /// unseen for long. `motions`, by layer: others than moving ones have nothing to look at.
    std::uint64_t begin(const SceneSteps& steps, const std::vector<LayerMotion>& motions, bool all);

    /// Of this look; valid between begin() and end().
    bool looked_at(std::size_t layer) const { return layers_[layer].looked_now; }
    /// The longest time since the last look at one of its layers; at least a step.
    std::int64_t longest_gap_us() const { return longest_gap_us_; }
    /// When a pixel near these layers, bits as begin() gives them, has looked last at the latest.
    std::int64_t since_us(std::uint64_t layers) const;

    /// The look has been taken.
    void end(const SceneSteps& steps);

    /// Every pixel has looked at everything now.
    void all_looked(const SceneSteps& steps);

    /// Nothing will be seen any more that happened before this time.
    std::int64_t settled_us(const SceneSteps& steps) const;

 private:
    struct Layer {
        PlanarMap looked;  // where it was when its pixels last looked
        // When the last looks were, the newest first.
        std::array<std::int64_t, LookSpacing::greatest_stride> looks_us{};
        bool looked_now = false;
    };

    double max_step_px_;
    std::vector<Layer> layers_;
    std::int64_t longest_gap_us_ = 0;
};

}  // namespace pursuit::sensor
