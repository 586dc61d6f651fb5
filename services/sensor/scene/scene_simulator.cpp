// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/scene_simulator.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::sensor {
namespace {

/// A pixel is a square of side 1: its variance comes on top of the optics'.
constexpr double pixel_variance_px2 = 1.0 / 12;

/// How far edges may move before the pixels near them are found anew.
constexpr double mark_margin_px = 2;

/// A resting layer that has moved by this much is a moving one.
constexpr double rest_px = 0.02;

/// The pixels near moving edges are found anew after this many steps, or this time, at the latest:
/// directions turn, and what was blind sees again.
constexpr std::int64_t longest_mark_steps = 40;
constexpr std::int64_t longest_mark_us = 16'000;

double sigma_px(const disk::SceneSensor& sensor) {
    return std::sqrt(sensor.blur_px() * sensor.blur_px() + pixel_variance_px2);
}

}  // namespace

SceneSimulator::SceneSimulator(const Scene& scene, std::uint64_t seed)
    : drawn_(draw_scene(scene, seed)),
      models_(draw_models(scene, drawn_, seed)),
      steps_(drawn_),
      edges_(drawn_, sigma_px(drawn_.sensor)),
      active_(drawn_.geometry, drawn_.background_reflectance, mark_margin_px),
      looks_(steps_, drawn_.sensor.max_step_px()),
      plan_(static_cast<std::size_t>(drawn_.geometry.width) * drawn_.geometry.height),
      spacing_(drawn_.sensor.max_step_px(), edges_.sigma_px()) {
    if (scene.description().duration_s() > 0) {
        duration_us_ = std::llround(scene.description().duration_s() * 1e6);
    }
    for (const auto& layer : steps_.layers()) {
        edges_.place(motions_.size(), layer.now);
        motions_.push_back(layer.fixed ? LayerMotion::fixed : LayerMotion::moving);
        marked_.push_back(layer.now);
    }
    pixels_.emplace(drawn_.geometry, drawn_.sensor, seed, active_.brightness_of_all(edges_));
    mark();
}

std::vector<TruthRow> SceneSimulator::truth(std::int64_t t_us) const {
    return truth_at(drawn_, t_us);
}

bool SceneSimulator::mark_needed() {
    bool needed = steps_.now_us() >= mark_until_us_;
    moved_px_ = 0;
    for (std::size_t i = 0; i < motions_.size(); ++i) {
        if (motions_[i] == LayerMotion::fixed) continue;
        const auto& layer = steps_.layers()[i];
        const double moved_px = steps_.displacement_px(layer, marked_[i], layer.now);
        moved_px_ = std::max(moved_px_, moved_px);
        needed |= moved_px > (motions_[i] == LayerMotion::resting ? rest_px : active_.margin_px());
    }
    return needed;
}

/// Finds the pixels near moving edges anew.
void SceneSimulator::mark() {
    const auto now_us = steps_.now_us();
    for (std::size_t i = 0; i < motions_.size(); ++i) {
        if (motions_[i] == LayerMotion::fixed) continue;
        const auto& layer = steps_.layers()[i];
        const bool moved = now_us == 0 || !(marked_[i] == layer.now);
        motions_[i] = moved ? LayerMotion::moving : LayerMotion::resting;
        marked_[i] = layer.now;
        edges_.place(i, layer.now);
        edges_.note_motion(i, layer.before, layer.now, layer.step_px);
    }
    mark_until_us_ = now_us + std::min(longest_mark_steps * steps_.step_us(), longest_mark_us);
    active_.mark(edges_, motions_, pixels_->blind_until_us(), mark_until_us_);
    moved_px_ = 0;
    plan_.restart(active_.pixels());
}

/// Lets the pixels near layers that have moved far enough look at them.
void SceneSimulator::look(bool marked) {
    const auto now_us = steps_.now_us();
    const std::uint64_t due = looks_.begin(steps_, motions_, marked);
    if (due == 0) return;
    for (std::size_t i = 0; i < motions_.size() && !marked; ++i) {
        if (looks_.looked_at(i)) edges_.place(i, steps_.layers()[i].now);
    }
    // What a pixel sees that stays blind for longer than this is forgotten before it matters.
    const std::int64_t soon_us = 2 * looks_.longest_gap_us();
    const float unknown_sigmas = active_.unknown_sigmas(edges_, moved_px_);
    for (const auto active : plan_.begin_look()) {
        const auto& pixel = active_.pixels()[active];
        if ((pixel.layers & due) == 0) {
            plan_.postpone(active, 1);
            continue;
        }
        if (pixels_->blind_beyond(pixel.index, now_us + soon_us)) {
            // Looks may come more rarely meanwhile: half of the way, then again.
            const auto left_us = pixels_->blind_until_us()[pixel.index] - now_us;
            const auto skip = std::min<std::int64_t>(left_us / soon_us, LookPlan::greatest_skip);
            plan_.postpone(active, static_cast<std::uint32_t>(skip));
            continue;
        }
        const auto sight = active_.sight(edges_, pixel);
        pixels_->look(pixel.index, looks_.since_us(pixel.layers & due), now_us, sight.brightness,
                      pending_);
        const auto looks = spacing_.looks_without_event(pixel, sight.nearness,
                                                        pixels_->room(pixel.index), unknown_sigmas);
        plan_.after_look(active, pixel.index, looks);
    }
    looks_.end(steps_);
}

/// Every pixel looks just before a layer comes or goes, and just after.
void SceneSimulator::come_and_go() {
    const auto now_us = steps_.now_us();
    const auto all_look = [&](std::int64_t since_us, std::int64_t t_us) {
        const auto brightness = active_.brightness_of_all(edges_);
        for (std::uint32_t i = 0; i < brightness.size(); ++i) {
            pixels_->look(i, since_us, t_us, brightness[i], pending_);
        }
    };
    for (std::size_t i = 0; i < motions_.size(); ++i) {
        edges_.place(i, place_of(drawn_, drawn_.layers[i], now_us - 1));
    }
    all_look(now_us - steps_.step_us(), now_us - 1);
    for (std::size_t i = 0; i < motions_.size(); ++i) edges_.place(i, steps_.layers()[i].now);
    all_look(now_us - 1, now_us);
    looks_.all_looked(steps_);
    plan_.forget();
    mark_until_us_ = now_us;
}

void SceneSimulator::step() {
    steps_.advance(drawn_);
    pixels_->noise(steps_.now_us(), pending_);
    if (steps_.comes_or_goes()) come_and_go();
    const bool marking = mark_needed();
    if (marking) mark();
    look(marking);
}

bool SceneSimulator::next(std::int64_t slice_us, std::vector<Event>& events,
                          std::vector<Event>* exposures) {
    if (duration_us_ && time_us_ >= *duration_us_) return false;
    std::int64_t end_us = time_us_ + std::max<std::int64_t>(slice_us, 1);
    if (duration_us_) end_us = std::min(end_us, *duration_us_);
    while (looks_.settled_us(steps_) < end_us + pixels_->greatest_lead_us()) step();

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
