// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/scene_steps.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace pursuit::sensor {
namespace {

/// No step is longer, so that motion that begins is noticed.
constexpr std::int64_t longest_step_us = 1000;

/// Where nothing is seen.
constexpr double away_px = 1e7;

/// A step may be this much longer than wanted before it is tried again.
constexpr double step_slack = 1.05;

std::vector<Point> bounding_corners(const DrawnLayer& layer) {
    Point low = layer.polygons.front().vertices.front();
    Point high = low;
    for (const auto& polygon : layer.polygons) {
        for (const Point& v : polygon.vertices) {
            low = low.cwiseMin(v);
            high = high.cwiseMax(v);
        }
    }
    return {low, high, {low.x(), high.y()}, {high.x(), low.y()}};
}

}  // namespace

PlanarMap place_of(const DrawnScene& scene, const DrawnLayer& layer, std::int64_t t_us) {
    if (!layer.there(t_us)) {
        PlanarMap away;
        away.matrix(0, 2) = away.matrix(1, 2) = away_px;
        return away;
    }
    return image_from_layer(scene, layer, static_cast<double>(t_us) / 1e6);
}

SceneSteps::SceneSteps(const DrawnScene& scene)
    : geometry_(scene.geometry), max_step_px_(scene.sensor.max_step_px()) {
    for (const DrawnLayer& drawn : scene.layers) {
        Layer layer;
        layer.fixed = drawn.polygons.empty() || (drawn.trajectory.constant() &&
                                                 scene.camera.constant() && !drawn.comes_or_goes());
        if (!drawn.polygons.empty()) layer.corners = bounding_corners(drawn);
        layer.before = layer.now = layer.next = place_of(scene, drawn, 0);
        layers_.push_back(std::move(layer));
        for (const auto t_us : {drawn.from_us, drawn.to_us}) {
            if (t_us > 0 && t_us < INT64_MAX) changes_us_.push_back(t_us);
        }
    }
    std::sort(changes_us_.begin(), changes_us_.end());
    changes_us_.erase(std::unique(changes_us_.begin(), changes_us_.end()), changes_us_.end());
}

std::int64_t SceneSteps::next_change_us() const {
    return next_change_ < changes_us_.size() ? changes_us_[next_change_] : INT64_MAX;
}

double SceneSteps::displacement_px(const Layer& layer, const PlanarMap& a,
                                   const PlanarMap& b) const {
    double of_box = 0;
    for (const Point& corner : layer.corners) {
        of_box = std::max(of_box, (b * corner - a * corner).norm());
    }
    if (of_box < 1e-9) return 0;
    const double border = 8;
    const double right = geometry_.width + border;
    const double bottom = geometry_.height + border;
    const PlanarMap layer_from_image{a.matrix.inverse()};
    double of_image = 0;
    for (const Point& p : {Point(-border, -border), Point(right, -border), Point(-border, bottom),
                           Point(right, bottom)}) {
        of_image = std::max(of_image, (b * (layer_from_image * p) - p).norm());
    }
    return std::min(of_box, of_image);
}

/// Places every layer one step ahead and returns that time.
std::int64_t SceneSteps::place_next(const DrawnScene& scene) {
    double step_us = static_cast<double>(std::min(2 * step_us_, longest_step_us));
    for (;;) {
        const auto whole_us =
            std::min(std::max<std::int64_t>(static_cast<std::int64_t>(step_us), 1),
                     next_change_us() - now_us_);
        const std::int64_t t_us = now_us_ + whole_us;
        double furthest_px = 0;
        for (std::size_t i = 0; i < layers_.size(); ++i) {
            Layer& layer = layers_[i];
            if (layer.fixed) continue;
            const DrawnLayer& drawn = scene.layers[i];
            layer.next = place_of(scene, drawn, t_us);
            layer.step_px = drawn.there(now_us_) == drawn.there(t_us)
                                ? displacement_px(layer, layer.now, layer.next)
                                : 0;
            furthest_px = std::max(furthest_px, layer.step_px);
        }
        if (furthest_px <= max_step_px_ * step_slack || whole_us == 1) {
            step_us_ = whole_us;
            return t_us;
        }
        step_us = std::max(step_us * max_step_px_ / furthest_px, 1.0);
    }
}

void SceneSteps::advance(const DrawnScene& scene) {
    now_us_ = place_next(scene);
    for (Layer& layer : layers_) {
        layer.before = layer.now;
        layer.now = layer.next;
    }
    comes_or_goes_ = now_us_ == next_change_us();
    if (comes_or_goes_) ++next_change_;
}

}  // namespace pursuit::sensor
