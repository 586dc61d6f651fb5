// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/layer_looks.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace pursuit::sensor {
namespace {

/// So that a slow layer does not go unseen for longer.
constexpr std::int64_t longest_unseen_us = 5000;

}  // namespace

LayerLooks::LayerLooks(const SceneSteps& steps, double max_step_px)
    : max_step_px_(max_step_px), layers_(steps.layers().size()) {
    all_looked(steps);
}

std::uint64_t LayerLooks::begin(const SceneSteps& steps, const std::vector<LayerMotion>& motions,
                                bool all) {
    const auto now_us = steps.now_us();
    std::uint64_t due = 0;
    longest_gap_us_ = steps.step_us();
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        Layer& layer = layers_[i];
        const auto& place = steps.layers()[i];
        const double moved_px = motions[i] == LayerMotion::moving
                                    ? steps.displacement_px(place, layer.looked, place.now)
                                    : 0;
        if (moved_px == 0) {
            layer.looks_us.fill(now_us);
            continue;
        }
        const std::int64_t gap_us = now_us - layer.looks_us.front();
        if (gap_us < longest_unseen_us && !all && moved_px + place.step_px <= max_step_px_) {
            continue;
        }
        due |= std::uint64_t{1} << (i % 64);
        longest_gap_us_ = std::max(longest_gap_us_, gap_us);
        layer.looked = place.now;
        layer.looked_now = true;
    }
    return due;
}

std::int64_t LayerLooks::since_us(std::uint64_t layers) const {
    return layers_[static_cast<std::size_t>(std::countr_zero(layers))].looks_us.back();
}

void LayerLooks::end(const SceneSteps& steps) {
    for (Layer& layer : layers_) {
        if (!std::exchange(layer.looked_now, false)) continue;
        std::shift_right(layer.looks_us.begin(), layer.looks_us.end(), 1);
        layer.looks_us.front() = steps.now_us();
    }
}

void LayerLooks::all_looked(const SceneSteps& steps) {
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        layers_[i].looked = steps.layers()[i].now;
        layers_[i].looks_us.fill(steps.now_us());
    }
}

std::int64_t LayerLooks::settled_us(const SceneSteps& steps) const {
    std::int64_t settled_us = steps.now_us();
    for (const Layer& layer : layers_) settled_us = std::min(settled_us, layer.looks_us.back());
    return settled_us;
}

}  // namespace pursuit::sensor
