// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/scene_simulator.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace pursuit::sensor {
namespace {

/// A pixel is a square of side 1: its variance comes on top of the optics'.
constexpr double pixel_variance_px2 = 1.0 / 12;

/// How far edges may move before the pixels near them are found anew.
constexpr double mark_margin_px = 2;

/// A resting layer that has moved by this much is a moving one.
constexpr double rest_px = 0.02;

/// No step is longer, so that motion that begins is noticed; nor does a slow layer go unseen
/// longer.
constexpr std::int64_t longest_step_us = 1000;
constexpr std::int64_t longest_unseen_us = 5000;

/// The pixels near moving edges are found anew after this many steps, or this time, at the latest:
/// directions turn, and what was blind sees again.
constexpr std::int64_t longest_mark_steps = 40;
constexpr std::int64_t longest_mark_us = 16'000;

/// Where nothing is seen.
constexpr double away_px = 1e7;

/// A step may be this much longer than wanted before it is tried again.
constexpr double step_slack = 1.05;

double sigma_px(const disk::SceneSensor& sensor) {
    return std::sqrt(sensor.blur_px() * sensor.blur_px() + pixel_variance_px2);
}

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

SceneSimulator::SceneSimulator(const Scene& scene, std::uint64_t seed)
    : drawn_(draw_scene(scene, seed)),
      models_(draw_models(scene, drawn_, seed)),
      edges_(drawn_, sigma_px(drawn_.sensor)),
      active_(drawn_.geometry, drawn_.background_reflectance, mark_margin_px) {
    if (scene.description().duration_s() > 0) {
        duration_us_ = std::llround(scene.description().duration_s() * 1e6);
    }
    for (std::size_t i = 0; i < drawn_.layers.size(); ++i) {
        const DrawnLayer& layer = drawn_.layers[i];
        LayerState state;
        const bool fixed =
            layer.polygons.empty() ||
            (layer.trajectory.constant() && drawn_.camera.constant() && !layer.comes_or_goes());
        state.motion = fixed ? LayerMotion::fixed : LayerMotion::moving;
        if (!layer.polygons.empty()) state.corners = bounding_corners(layer);
        state.before = state.now = state.next = state.looked = state.marked = place_of(i, 0);
        edges_.place(i, state.now);
        layers_.push_back(std::move(state));
        for (const auto t_us : {layer.from_us, layer.to_us}) {
            if (t_us > 0 && t_us < INT64_MAX) changes_us_.push_back(t_us);
        }
    }
    std::sort(changes_us_.begin(), changes_us_.end());
    changes_us_.erase(std::unique(changes_us_.begin(), changes_us_.end()), changes_us_.end());
    next_look_.assign(static_cast<std::size_t>(drawn_.geometry.width) * drawn_.geometry.height, 0);
    pixels_.emplace(drawn_.geometry, drawn_.sensor, seed, active_.brightness_of_all(edges_));
    mark();
}

std::vector<TruthRow> SceneSimulator::truth(std::int64_t t_us) const {
    return truth_at(drawn_, t_us);
}

/// image_from_layer; of a layer that is not there, one that takes it far out of the image.
PlanarMap SceneSimulator::place_of(std::size_t layer, std::int64_t t_us) const {
    if (!drawn_.layers[layer].there(t_us)) {
        PlanarMap away;
        away.matrix(0, 2) = away.matrix(1, 2) = away_px;
        return away;
    }
    return image_from_layer(drawn_, drawn_.layers[layer], static_cast<double>(t_us) / 1e6);
}

std::int64_t SceneSimulator::next_change_us() const {
    return next_change_ < changes_us_.size() ? changes_us_[next_change_] : INT64_MAX;
}

/// How far anything of the layer that is in the image moves between two maps: at most as far as
/// the corners of its bounding box, and as what is at the corners of the image.
double SceneSimulator::displacement_px(const LayerState& layer, const PlanarMap& a,
                                       const PlanarMap& b) const {
    double of_box = 0;
    for (const Point& corner : layer.corners) {
        of_box = std::max(of_box, (b * corner - a * corner).norm());
    }
    if (of_box < 1e-9) return 0;
    const double border = 8;
    const double right = drawn_.geometry.width + border;
    const double bottom = drawn_.geometry.height + border;
    const PlanarMap layer_from_image{a.matrix.inverse()};
    double of_image = 0;
    for (const Point& p : {Point(-border, -border), Point(right, -border), Point(-border, bottom),
                           Point(right, bottom)}) {
        of_image = std::max(of_image, (b * (layer_from_image * p) - p).norm());
    }
    return std::min(of_box, of_image);
}

/// Places every layer one step ahead and returns that time.
std::int64_t SceneSimulator::place_next() {
    const double wanted_px = drawn_.sensor.max_step_px();
    double step_us = static_cast<double>(std::min(2 * step_us_, longest_step_us));
    for (;;) {
        const auto whole_us =
            std::min(std::max<std::int64_t>(static_cast<std::int64_t>(step_us), 1),
                     next_change_us() - now_us_);
        const std::int64_t t_us = now_us_ + whole_us;
        double furthest_px = 0;
        for (std::size_t i = 0; i < layers_.size(); ++i) {
            LayerState& layer = layers_[i];
            if (layer.motion == LayerMotion::fixed) continue;
            layer.next = place_of(i, t_us);
            const DrawnLayer& drawn = drawn_.layers[i];
            layer.step_px = drawn.there(now_us_) == drawn.there(t_us)
                                ? displacement_px(layer, layer.now, layer.next)
                                : 0;
            furthest_px = std::max(furthest_px, layer.step_px);
        }
        if (furthest_px <= wanted_px * step_slack || whole_us == 1) {
            step_us_ = whole_us;
            return t_us;
        }
        step_us = std::max(step_us * wanted_px / furthest_px, 1.0);
    }
}

bool SceneSimulator::mark_needed() {
    bool needed = now_us_ >= mark_until_us_;
    moved_px_ = 0;
    for (const LayerState& layer : layers_) {
        if (layer.motion == LayerMotion::fixed) continue;
        const double moved_px = displacement_px(layer, layer.marked, layer.now);
        moved_px_ = std::max(moved_px_, moved_px);
        needed |= moved_px > (layer.motion == LayerMotion::resting ? rest_px : active_.margin_px());
    }
    return needed;
}

void SceneSimulator::mark() {
    std::vector<LayerMotion> motions;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        LayerState& layer = layers_[i];
        if (layer.motion != LayerMotion::fixed) {
            const bool moved = now_us_ == 0 || !(layer.marked == layer.now);
            layer.motion = moved ? LayerMotion::moving : LayerMotion::resting;
            layer.marked = layer.now;
            edges_.place(i, layer.now);
            edges_.note_motion(i, layer.before, layer.now, layer.step_px);
        }
        motions.push_back(layer.motion);
    }
    mark_until_us_ = now_us_ + std::min(longest_mark_steps * step_us_, longest_mark_us);
    active_.mark(edges_, motions, pixels_->blind_until_us(), mark_until_us_);
    moved_px_ = 0;
    plan_looks();
}

void SceneSimulator::plan_looks() {
    for (auto& look : plan_) look.clear();
    const auto& pixels = active_.pixels();
    for (std::uint32_t i = 0; i < pixels.size(); ++i) {
        plan_look(i, std::max(next_look_[pixels[i].index], look_count_ + 1));
    }
}

void SceneSimulator::plan_look(std::uint32_t active, std::uint64_t look) {
    plan_[look % plan_.size()].push_back(active);
}

/// How many looks from now the next one may be, at least 1. With n edges that move by `way` a look
/// no nearer than d, what the pixel sees changes in k looks by at most n · contrast · (tail(d - k
/// way) - tail(d)): no event comes before that has used up the room to the next threshold. Edges
/// beyond the cut count as one of full contrast.
std::uint32_t SceneSimulator::looks_without_event(const ActivePixels::Pixel& pixel,
                                                  const ActivePixels::Sight& sight,
                                                  float unknown_sigmas) const {
    const auto way = static_cast<float>(drawn_.sensor.max_step_px() / edges_.sigma_px());
    const auto stride =
        static_cast<std::uint32_t>(1 / std::max(pixel.normal_share, 1.0F / greatest_stride));
    const float room = pixels_->room(pixel.index);
    if (room <= 0) return stride;
    const auto& gaussian = GaussianCoverage::tables();
    constexpr auto most = static_cast<float>(greatest_skip);
    const auto looks = [&](float contrast, float distance, float way_a_look) {
        const float share = room / contrast + gaussian.tail(distance);
        return share >= 1 ? most : (distance - gaussian.distance(share)) / way_a_look;
    };
    const auto [nearest, count] = sight.nearness;
    float safe = std::min(
        most, looks(1, std::min(unknown_sigmas, std::max(nearest, ImageEdges::cut_sigmas)), way));
    if (count > 0) {
        const float contrast = std::max(pixel.contrast, 1e-3F) * static_cast<float>(count);
        safe = std::min(safe, looks(contrast, nearest, way * std::max(pixel.normal_share, 0.01F)));
    }
    return std::max(static_cast<std::uint32_t>(std::max(safe, 0.0F)), stride);
}

/// Lets the pixels near layers that have moved far enough look at them.
void SceneSimulator::look(bool marked) {
    const double wanted_px = drawn_.sensor.max_step_px();
    std::uint64_t due = 0;
    std::int64_t longest_gap_us = step_us_;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        LayerState& layer = layers_[i];
        const double moved_px = layer.motion == LayerMotion::moving
                                    ? displacement_px(layer, layer.looked, layer.now)
                                    : 0;
        if (moved_px == 0) {
            layer.looks_us.fill(now_us_);
            continue;
        }
        const std::int64_t gap_us = now_us_ - layer.looks_us.front();
        if (gap_us < longest_unseen_us && !marked && moved_px + layer.step_px <= wanted_px) {
            continue;
        }
        due |= std::uint64_t{1} << (i % 64);
        longest_gap_us = std::max(longest_gap_us, gap_us);
        if (!marked) edges_.place(i, layer.now);
        layer.looked = layer.now;
        layer.looked_now = true;
    }
    if (due == 0) return;
    ++look_count_;
    // What a pixel sees that stays blind for longer than this is forgotten before it matters.
    const std::int64_t soon_us = 2 * longest_gap_us;
    const float unknown_sigmas = active_.unknown_sigmas(edges_, moved_px_);
    looking_.clear();
    looking_.swap(plan_[look_count_ % plan_.size()]);
    for (const auto active : looking_) {
        const auto& pixel = active_.pixels()[active];
        if ((pixel.layers & due) == 0) {
            plan_look(active, look_count_ + 1);
            continue;
        }
        if (pixels_->blind_beyond(pixel.index, now_us_ + soon_us)) {
            // Looks may come more rarely meanwhile: half of the way, then again.
            const auto left_us = pixels_->blind_until_us()[pixel.index] - now_us_;
            const auto skip = std::min<std::int64_t>(left_us / soon_us, greatest_skip);
            plan_look(active, look_count_ + static_cast<std::uint64_t>(skip));
            continue;
        }
        const auto sight = active_.sight(edges_, pixel);
        const LayerState& layer =
            layers_[static_cast<std::size_t>(std::countr_zero(pixel.layers & due))];
        pixels_->look(pixel.index, layer.looks_us.back(), now_us_, sight.brightness, pending_);
        next_look_[pixel.index] = look_count_ + looks_without_event(pixel, sight, unknown_sigmas);
        plan_look(active, next_look_[pixel.index]);
    }
    for (LayerState& layer : layers_) {
        if (!std::exchange(layer.looked_now, false)) continue;
        std::shift_right(layer.looks_us.begin(), layer.looks_us.end(), 1);
        layer.looks_us.front() = now_us_;
    }
}

/// Nothing will be seen any more that happened before this time.
std::int64_t SceneSimulator::settled_us() const {
    std::int64_t settled_us = now_us_;
    for (const LayerState& layer : layers_)
        settled_us = std::min(settled_us, layer.looks_us.back());
    return settled_us;
}

/// Every pixel looks just before a layer comes or goes, and just after.
void SceneSimulator::come_and_go() {
    const auto all_look = [&](std::int64_t since_us, std::int64_t t_us) {
        const auto brightness = active_.brightness_of_all(edges_);
        for (std::uint32_t i = 0; i < brightness.size(); ++i) {
            pixels_->look(i, since_us, t_us, brightness[i], pending_);
        }
    };
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        edges_.place(i, place_of(i, now_us_ - 1));
    }
    all_look(now_us_ - step_us_, now_us_ - 1);
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        edges_.place(i, layers_[i].now);
        layers_[i].looked = layers_[i].now;
        layers_[i].looks_us.fill(now_us_);
    }
    all_look(now_us_ - 1, now_us_);
    std::fill(next_look_.begin(), next_look_.end(), look_count_);
    mark_until_us_ = now_us_;
    ++next_change_;
}

void SceneSimulator::step() {
    now_us_ = place_next();
    for (LayerState& layer : layers_) {
        layer.before = layer.now;
        layer.now = layer.next;
    }
    pixels_->noise(now_us_, pending_);
    if (now_us_ == next_change_us()) come_and_go();
    const bool marking = mark_needed();
    if (marking) mark();
    look(marking);
}

bool SceneSimulator::next(std::int64_t slice_us, std::vector<Event>& events,
                          std::vector<Event>* exposures) {
    if (duration_us_ && time_us_ >= *duration_us_) return false;
    std::int64_t end_us = time_us_ + std::max<std::int64_t>(slice_us, 1);
    if (duration_us_) end_us = std::min(end_us, *duration_us_);
    while (settled_us() < end_us + pixels_->greatest_lead_us()) step();

    const auto later = std::partition(pending_.begin(), pending_.end(),
                                      [&](const Event& e) { return e.t_us < end_us; });
    const auto in_order = [](const Event& a, const Event& b) {
        if (a.t_us != b.t_us) return a.t_us < b.t_us;
        if (a.y != b.y) return a.y < b.y;
        if (a.x != b.x) return a.x < b.x;
        return a.polarity < b.polarity;
    };
    std::sort(pending_.begin(), later, in_order);
    events.insert(events.end(), pending_.begin(), later);
    pending_.erase(pending_.begin(), later);
    if (pixels_->has_exposures()) {
        unwanted_.clear();
        pixels_->take_exposures(end_us, exposures != nullptr ? *exposures : unwanted_);
    }
    time_us_ = end_us;
    return true;
}

}  // namespace pursuit::sensor
