// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/seeker.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace pursuit::tracker {
namespace {

constexpr std::int64_t longest_us = 40'000;
constexpr std::int64_t neighbour_us = 5'000;

// How often it is asked who wants to be looked for.
constexpr std::int64_t idle_us = 2'000;

// Poses looked at for each µs of event time, and for an event at most.
constexpr std::int64_t poses_per_us = 40;
constexpr std::int64_t most_poses = 4'000;

// Events a px of contour: of a way of 2 px or so, when the shape is alone. Where it is not, more
// are needed, and the first may be too few: by turns.
constexpr double events_per_px = 3;

// The second look, at where the shape has gone during the first.
constexpr double again_reach_px = 15;
constexpr double again_angle_rad = 0.4;
constexpr double again_log_scale = 0.1;

}  // namespace

void Seeker::restart(Geometry geometry) {
    geometry_ = geometry;
    ring_.assign(ring_events, {});
    next_ = 0;
    fired_us_.assign(std::size_t{geometry.width} * geometry.height, 0);
    object_id_ = last_object_id_ = 0;
    attempt_ = 0;
    due_us_ = 0;
}

void Seeker::go_on(std::int64_t t_us, std::span<Track> tracks) {
    if (object_id_ == 0) {
        begin(t_us, tracks);
        return;
    }
    const auto track = std::find_if(tracks.begin(), tracks.end(), [&](const Track& candidate) {
        return candidate.object_id() == object_id_;
    });
    if (track == tracks.end() || !track->wanted(t_us, geometry_)) {
        object_id_ = 0;
        return;
    }
    const std::int64_t poses = std::min((t_us - worked_us_) * poses_per_us, most_poses);
    worked_us_ = t_us;
    search_.step(static_cast<int>(poses));
    if (search_.is_done()) end(t_us, *track);
}

void Seeker::begin(std::int64_t t_us, std::span<Track> tracks) {
    due_us_ = t_us + idle_us;
    // By turns: those after the last first.
    Track* chosen = nullptr;
    for (int round = 0; round < 2 && chosen == nullptr; ++round) {
        for (Track& track : tracks) {
            if (round == 0 && track.object_id() <= last_object_id_) continue;
            if (!track.wanted(t_us, geometry_)) continue;
            chosen = &track;
            break;
        }
    }
    if (chosen == nullptr) return;
    if (chosen->object_id() != last_object_id_) attempt_ = 0;
    const SearchRange range = *chosen->wanted(t_us, geometry_);
    const std::size_t count = wanted_events(*chosen);
    ++attempt_;
    last_object_id_ = chosen->object_id();
    gather(t_us, range, chosen->radius_px(), count);
    if (gathered_.size() < count / 8) return;
    map_.build(geometry_, gathered_);
    search_ = ShapeSearch(chosen->contour());
    search_.begin(map_, range);
    object_id_ = chosen->object_id();
    worked_us_ = t_us;
    due_us_ = t_us;
}

std::size_t Seeker::wanted_events(const Track& track) const {
    const double scale = track.radius_px() / std::max(track.contour().radius_px(), 1e-9);
    const double once = events_per_px * track.contour().length_px() * scale;
    constexpr std::array times{1.0, 3.0, 9.0};
    return std::clamp(static_cast<std::size_t>(once * times[attempt_ % times.size()]),
                      std::size_t{100}, ring_events);
}

void Seeker::end(std::int64_t t_us, Track& track) {
    object_id_ = 0;
    due_us_ = t_us + idle_us;
    if (!search_.found()) return;
    SearchRange again{search_.found()->pose, again_reach_px, again_angle_rad,
                      track.has_fixed_scale() ? 0 : again_log_scale, again_reach_px};
    gather(t_us, again, track.radius_px(),
           static_cast<std::size_t>(events_per_px * track.contour().length_px()));
    map_.build(geometry_, gathered_);
    search_.begin(map_, again);
    search_.step(1 << 30);
    if (search_.found()) track.offer(t_us, search_.found()->pose);
}

void Seeker::gather(std::int64_t t_us, const SearchRange& range, double radius_px,
                    std::size_t count) {
    gathered_.clear();
    const double reach_px = range.reach_px + radius_px + 8;
    const auto is_in_reach = [&](const Event& event) {
        return std::abs(event.x - range.around.t_px.x()) < reach_px &&
               std::abs(event.y - range.around.t_px.y()) < reach_px;
    };
    const std::size_t kept = std::min(next_, ring_.size());
    const int width = geometry_.width;
    const int height = geometry_.height;
    std::fill(fired_us_.begin(), fired_us_.end(), std::int64_t{-1} << 40);
    std::size_t first = next_;
    for (std::size_t i = 0; i < kept; ++i) {
        const Event& event = ring_[(next_ - 1 - i) % ring_events];
        if (t_us - event.t_us > longest_us) break;
        first = next_ - 1 - i;
    }
    const auto at = [&](int x, int y) -> std::int64_t& {
        return fired_us_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                         static_cast<std::size_t>(x)];
    };
    // Forwards, as they came: supported by a neighbour that fired shortly before.
    for (std::size_t i = first; i < next_; ++i) {
        const Event& event = ring_[i % ring_events];
        bool is_supported = false;
        for (int y = std::max(event.y - 1, 0); y <= std::min(event.y + 1, height - 1); ++y) {
            for (int x = std::max(event.x - 1, 0); x <= std::min(event.x + 1, width - 1); ++x) {
                const bool is_itself = x == event.x && y == event.y;
                is_supported |= !is_itself && event.t_us - at(x, y) < neighbour_us;
            }
        }
        at(event.x, event.y) = event.t_us;
        if (is_supported && is_in_reach(event)) gathered_.push_back(event);
    }
    if (gathered_.size() > count) {
        gathered_.erase(gathered_.begin(), gathered_.end() - static_cast<std::ptrdiff_t>(count));
    }
}

}  // namespace pursuit::tracker
