// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/spatiotemporal.hpp"

#include <algorithm>

#include "services/tracker/core/association/by_distance.hpp"

namespace pursuit::tracker {
namespace {

// Fewer say nothing about a plane.
constexpr std::uint64_t least_events = 20;

// StrategyParameters::plane_feed; every other value: every event near the object.
constexpr double feed_taken = 0;
constexpr double feed_unambiguous = 2;

std::int64_t whole_us(double s) { return static_cast<std::int64_t>(s * 1e6); }

}  // namespace

void Spatiotemporal::near(const Event& event, std::span<const Claim> claims) {
    if (parameters_.plane_feed == feed_taken) return;
    const auto is_near = [&](const Claim& claim) {
        return claim.distance_px <= parameters_.ambiguity_px;
    };
    if (parameters_.plane_feed == feed_unambiguous &&
        std::count_if(claims.begin(), claims.end(), is_near) > 1) {
        return;
    }
    for (const Claim& claim : claims) {
        if (is_near(claim)) feed(event, claim.object_id);
    }
}

void Spatiotemporal::used(const Event& event, const Claim& claim) {
    if (parameters_.plane_feed == feed_taken) feed(event, claim.object_id);
}

void Spatiotemporal::assign(const Event& event, std::span<Claim> claims) {
    Claim* best = nullptr;
    double best_distance = 0;
    for (Claim& claim : claims) {
        claim.weight = 0;
        const auto off = distance(event, claim.object_id);
        if (!off) {
            Closest().assign(event, claims);
            return;
        }
        // (3.14)
        if (best == nullptr || *off < best_distance) {
            best = &claim;
            best_distance = *off;
        }
    }
    const bool is_background =
        parameters_.plane_filters_background != 0 && best_distance > parameters_.plane_reach;
    best->weight = is_background ? 0 : 1;
}

void Spatiotemporal::confirm(const Event& event, Claim& claim) {
    if (parameters_.plane_filters_unambiguous == 0) return;
    const auto off = distance(event, claim.object_id);
    if (off && *off > parameters_.plane_reach) claim.weight = 0;
}

void Spatiotemporal::forget(std::uint32_t object_id) {
    std::erase_if(objects_, [&](const Object& object) { return object.object_id == object_id; });
}

Spatiotemporal::Object* Spatiotemporal::find(std::uint32_t object_id) {
    for (Object& object : objects_) {
        if (object.object_id == object_id) return &object;
    }
    return nullptr;
}

void Spatiotemporal::feed(const Event& event, std::uint32_t object_id) {
    Object* object = find(object_id);
    if (object == nullptr) {
        const EventWindow window(whole_us(parameters_.plane_window_s),
                                 static_cast<std::size_t>(parameters_.plane_events),
                                 parameters_.plane_last_per_pixel != 0);
        objects_.push_back({object_id, window, {}});
        object = &objects_.back();
    }
    object->window.add(event);
}

std::optional<double> Spatiotemporal::distance(const Event& event, std::uint32_t object_id) {
    Object* object = find(object_id);
    if (object == nullptr) return std::nullopt;
    object->window.reach(event.t_us);
    const EventWindow& window = object->window;
    if (!window.is_whole(event.t_us) || window.sums().count() < least_events) return std::nullopt;
    if (!object->plane || event.t_us - object->plane->t_us >= whole_us(parameters_.plane_refit_s)) {
        object->plane = window.sums().fit(parameters_.plane_time_px_s * 1e-6, event.t_us);
    }
    const double off_px = object->plane->distance_px(event.x, event.y, event.t_us);
    return parameters_.plane_in_sigma != 0 ? off_px / object->plane->sigma_px : off_px;
}

}  // namespace pursuit::tracker
