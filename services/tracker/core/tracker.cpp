// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/tracker.hpp"

#include <algorithm>
#include <deque>
#include <functional>

#include "services/tracker/core/association/arbiter.hpp"
#include "services/tracker/core/occlusion.hpp"
#include "services/tracker/core/pose_grid.hpp"
#include "services/tracker/core/reach_map.hpp"
#include "services/tracker/core/recent_pixels.hpp"
#include "services/tracker/core/registry.hpp"
#include "services/tracker/core/seeker.hpp"
#include "services/tracker/core/track.hpp"

namespace pursuit::tracker {
namespace {

// Beyond it microseconds are no longer whole in a double; 285 years.
constexpr std::int64_t max_t_us = std::int64_t{1} << 53;

// Calls that wait for the next event, in a silence; more are refused.
constexpr std::size_t most_held_changes = 1024;

constexpr std::int64_t round_us = 500;

// Where a track is, is noted in the map after so many of its events; ReachMap::place() has room for
// what they move it.
constexpr std::uint64_t placed_every_events = 8;

// How far ahead of the event in hand the pixels of those to come are fetched from memory.
constexpr std::size_t prefetched = 16;

CallResult<void> check_range(std::string_view field, double value, double min, double max) {
    if (value >= min && value <= max) return {};
    return refuse(CallStatus::invalid_argument, std::string(field) + ": " + std::to_string(value) +
                                                    " is not within " + std::to_string(min) +
                                                    " to " + std::to_string(max));
}

}  // namespace

class Tracker::Impl {
 public:
    Impl(TrackerOptions given, const Preset& preset)
        : options(std::move(given)),
          registry(options.max_objects, options.next_object_id, preset),
          grid(options.pose_rate_hz, options.max_poses_per_s),
          arbiter(options.max_objects, preset.strategy, preset.strategy_parameters) {
        tells_occlusion = preset.tracker.tells_occlusion >= 0.5;
    }

    /// A call's effect on the tracks, held back until the last processed time is over.
    struct Change {
        std::int64_t effective_time_us;
        std::function<void()> apply;
    };

    [[nodiscard]] std::int64_t effective_time_us() const { return last_t_us + 1; }

    [[nodiscard]] CallResult<void> has_room() const {
        if (changes.size() < most_held_changes) return {};
        return refuse(CallStatus::limit_exceeded,
                      std::to_string(most_held_changes) + " calls wait for the next event");
    }

    // Before the first event of a stream nothing is to be done first, and there is time.
    void hold(std::function<void()> change) {
        if (options.only_checks) return;
        changes.push_back({effective_time_us(), std::move(change)});
        wake_us = 0;
        if (last_t_us < 0) apply_changes();
    }

    void apply_changes() {
        for (Change& change : changes) change.apply();
        changes.clear();
        occlusion.restart();
        restart_round();
    }

    // `now_us` begins: what was called for before it takes effect, in turn with the poses due.
    void reach(std::int64_t now_us, PoseSink& sink) {
        while (!changes.empty() && changes.front().effective_time_us <= now_us) {
            emit_before(changes.front().effective_time_us, sink);
            changes.front().apply();
            occlusion.restart();
            restart_round();
            changes.pop_front();
        }
        emit_before(now_us + 1, sink);
    }

    void emit_before(std::int64_t end_us, PoseSink& sink) {
        for (; grid.next_us() < end_us; grid.step()) {
            for (const Track& track : tracks) {
                if (!grid.is_due(track.object_id(), tracks.size())) {
                    ++counters.poses_thinned;
                    continue;
                }
                PoseRecord record = track.record(grid.next_us());
                record.stream_id = stream_id;
                sink.pose(record);
                ++counters.poses_emitted;
            }
        }
    }

    bool accepts(const Event& event) {
        if (event.t_us < 0 || event.t_us >= max_t_us) {
            ++counters.dropped_time_out_of_range;
            return false;
        }
        if (event.t_us < last_t_us) {
            ++counters.dropped_time_went_back;
            return false;
        }
        if (event.x >= geometry.width || event.y >= geometry.height) {
            ++counters.dropped_outside_geometry;
            return false;
        }
        return true;
    }

    // What is done from time to time, before the first event at or after wake_us.
    void wake(std::int64_t t_us) {
        if (tells_occlusion && t_us >= occlusion.next_us()) occlusion.look(t_us, tracks);
        seeker.work(t_us, tracks);
        if (t_us >= next_round_us) go_round(t_us);
        wake_us = std::min({grid.next_us(), next_round_us, seeker.next_us()});
        if (tells_occlusion) wake_us = std::min(wake_us, occlusion.next_us());
        if (!changes.empty()) wake_us = std::min(wake_us, changes.front().effective_time_us);
    }

    // The paper's algorithm, for one event. (Always inlined: gcc would not.)
    [[gnu::always_inline]] void process(const Event& event, PoseSink& sink) {
        const std::int64_t since_same_us = recent.note(event);
        seeker.see(event);

        // The objects it may belong to, by the nearest place of each model (3.1).
        arbiter.begin();
        reach_map.for_each(event.x, event.y, [&](std::size_t i) {
            Track& track = tracks[i];
            const Approach near = track.approach(event, since_same_us);
            if (!near.is_within()) return;
            if (tells_occlusion && occlusion.hides(i, event, tracks)) {
                track.deny();
                return;
            }
            arbiter.claim(i, track.object_id(), near.distance_px, near.clutter);
        });
        if (arbiter.count() == 0) {
            ++counters.events_unused;
            return;
        }

        // Whose it is (section 3.3), and the steps that follow from it (3.2).
        bool is_used = false;
        if (arbiter.is_plain()) {
            is_used = step(event, arbiter.claimant(0), 1, sink);
        } else {
            arbiter.give(event, [&](std::size_t i) { return tracks[i].likelihood(); });
            for (std::size_t i = 0; i < arbiter.count(); ++i) {
                if (!(arbiter.weight(i) > 0)) continue;
                if (!step(event, arbiter.claimant(i), arbiter.weight(i), sink)) continue;
                is_used = true;
                arbiter.used(event, i);
            }
        }
        ++(is_used ? counters.events_used : counters.events_unused);
    }

    // The event moves the pose of this track; false where it did not.
    bool step(const Event& event, std::size_t index, double weight, PoseSink& sink) {
        Track& track = tracks[index];
        const bool is_taken = track.take(event, weight);
        // One that lost its grip is asked about events from farther away.
        if (!is_taken || track.events_used() % placed_every_events == 0) {
            reach_map.place(index, track.reach(next_round_us));
        }
        if (is_taken && options.emit_updates) {
            sink.update({track.object_id(), stream_id, event.t_us, track.pose()});
        }
        return is_taken;
    }

    // Every track learns what time it is, and the map where it is.
    void go_round(std::int64_t t_us) {
        next_round_us = t_us + round_us;
        for (std::size_t i = 0; i < tracks.size(); ++i) {
            tracks[i].reach_time(t_us);
            reach_map.place(i, tracks[i].reach(next_round_us));
        }
    }

    void restart_round() {
        reach_map.restart(geometry, tracks.size());
        next_round_us = 0;
        wake_us = 0;
    }

    Track* find_track(std::uint32_t object_id) {
        const auto found = std::find_if(tracks.begin(), tracks.end(), [&](const Track& track) {
            return track.object_id() == object_id;
        });
        return found == tracks.end() ? nullptr : &*found;
    }

    TrackerOptions options;
    Registry registry;
    PoseGrid grid;
    TrackerCounters counters;
    Geometry geometry;
    std::uint64_t stream_id = 0;
    std::int64_t last_t_us = -1;
    std::deque<Change> changes;
    RecentPixels recent;
    Arbiter arbiter;
    std::vector<Track> tracks;  // in order of ids
    bool tells_occlusion = true;
    Occlusion occlusion;
    Seeker seeker;
    ReachMap reach_map;
    std::int64_t next_round_us = 0;
    std::int64_t wake_us = 0;  // not before it is there anything to do but to take events
};

CallResult<Tracker> Tracker::create(const TrackerOptions& options) {
    for (const auto& checked :
         {check_range("pose_rate_hz", options.pose_rate_hz, 1, 100'000),
          check_range("max_poses_per_s", options.max_poses_per_s, 1, 1e6),
          check_range("max_objects", options.max_objects, 1, 256),
          check_range("next_object_id", options.next_object_id, 1, UINT32_MAX - 1)}) {
        if (!checked) return tl::unexpected(checked.error());
    }
    auto preset = find_preset(options.preset);
    if (!preset) return tl::unexpected(preset.error());
    return Tracker(std::make_unique<Impl>(options, **preset));
}

Tracker::Tracker(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Tracker::Tracker(Tracker&& other) noexcept = default;
Tracker& Tracker::operator=(Tracker&& other) noexcept = default;
Tracker::~Tracker() = default;

void Tracker::begin_stream(Geometry geometry, std::uint64_t stream_id) {
    // Nothing of the former stream comes any more.
    impl_->apply_changes();
    impl_->geometry = geometry;
    impl_->stream_id = stream_id;
    impl_->last_t_us = -1;
    impl_->grid.restart();
    impl_->recent.restart(geometry);
    impl_->seeker.restart(geometry);
    impl_->arbiter.restart();
    for (Track& track : impl_->tracks) track.begin_stream();
    impl_->restart_round();
}

void Tracker::process(std::span<const Event> events, PoseSink& sink) {
    for (std::size_t i = 0; i < events.size(); ++i) {
        const Event& event = events[i];
        if (i + prefetched < events.size()) impl_->recent.prefetch(events[i + prefetched]);
        ++impl_->counters.events_in;
        if (!impl_->accepts(event)) continue;
        const bool is_due = event.t_us >= impl_->wake_us;
        if (is_due) impl_->reach(event.t_us, sink);
        impl_->last_t_us = event.t_us;
        impl_->grid.event_at(event.t_us);
        if (is_due) impl_->wake(event.t_us);
        impl_->process(event, sink);
    }
}

void Tracker::advance(std::int64_t t_us, PoseSink& sink) {
    if (t_us <= impl_->last_t_us || t_us >= max_t_us) return;
    impl_->reach(t_us, sink);
    impl_->last_t_us = t_us;
}

std::int64_t Tracker::last_t_us() const { return impl_->last_t_us; }
std::int64_t Tracker::effective_time_us() const { return impl_->effective_time_us(); }

CallResult<Registered> Tracker::register_object(const Registration& registration) {
    if (auto room = impl_->has_room(); !room) return tl::unexpected(room.error());
    auto registered = impl_->registry.add(registration, effective_time_us());
    if (!registered || registered->already_registered) return registered;
    impl_->hold([impl = impl_.get(), object = *impl_->registry.find(registered->object_id),
                 tracker = impl_->registry.settings().tracker] {
        const auto place =
            std::find_if(impl->tracks.begin(), impl->tracks.end(),
                         [&](const Track& track) { return track.object_id() > object.object_id; });
        impl->tracks.insert(place, Track(object, tracker));
    });
    return registered;
}

CallResult<void> Tracker::update_object(const ObjectUpdate& update) {
    if (auto room = impl_->has_room(); !room) return tl::unexpected(room.error());
    auto replaced = impl_->registry.replace(update, effective_time_us());
    if (!replaced) return tl::unexpected(replaced.error());
    impl_->hold([impl = impl_.get(), object = **replaced] {
        if (Track* track = impl->find_track(object.object_id)) track->replace(object);
    });
    return {};
}

CallResult<void> Tracker::remove_object(std::string_view name) {
    if (auto room = impl_->has_room(); !room) return tl::unexpected(room.error());
    auto removed = impl_->registry.remove(name);
    if (!removed) return tl::unexpected(removed.error());
    impl_->hold([impl = impl_.get(), object_id = *removed] {
        std::erase_if(impl->tracks,
                      [&](const Track& track) { return track.object_id() == object_id; });
        impl->arbiter.forget(object_id);
    });
    return {};
}

CallResult<void> Tracker::set_pose(std::string_view name, const Start& start) {
    if (auto room = impl_->has_room(); !room) return tl::unexpected(room.error());
    auto changed = impl_->registry.set_start(name, start, effective_time_us());
    if (!changed) return tl::unexpected(changed.error());
    impl_->hold([impl = impl_.get(), object = **changed] {
        if (Track* track = impl->find_track(object.object_id)) track->restart(object);
        impl->arbiter.forget(object.object_id);
    });
    return {};
}

CallResult<void> Tracker::set_strategy(StrategyKind kind, std::span<const NamedValue> parameters) {
    if (auto room = impl_->has_room(); !room) return tl::unexpected(room.error());
    auto changed = impl_->registry.set_strategy(kind, parameters, effective_time_us());
    if (!changed) return changed;
    impl_->hold([impl = impl_.get(), settings = impl_->registry.settings()] {
        impl->arbiter.set_strategy(settings.strategy, settings.strategy_parameters);
    });
    return {};
}

CallResult<void> Tracker::set_parameters(std::string_view name,
                                         std::span<const NamedValue> parameters) {
    if (auto room = impl_->has_room(); !room) return tl::unexpected(room.error());
    auto changed = impl_->registry.set_parameters(name, parameters, effective_time_us());
    if (!changed) return changed;
    impl_->hold([impl = impl_.get(), objects = impl_->registry.objects(),
                 tracker = impl_->registry.settings().tracker] {
        impl->tells_occlusion = tracker.tells_occlusion >= 0.5;
        if (!impl->tells_occlusion) {
            for (Track& track : impl->tracks) track.show_all(impl->last_t_us);
        }
        for (const RegisteredObject& object : objects) {
            if (Track* track = impl->find_track(object.object_id)) {
                track->set_parameters(object.parameters, tracker);
            }
        }
    });
    return {};
}

std::vector<std::string> Tracker::object_names() const {
    std::vector<std::string> names;
    for (const RegisteredObject& object : impl_->registry.objects()) {
        names.push_back(object.shape.name);
    }
    return names;
}

std::vector<RegisteredObject> Tracker::objects() const { return impl_->registry.objects(); }

CallResult<RegisteredObject> Tracker::object(std::string_view name) const {
    if (const RegisteredObject* found = impl_->registry.find(name)) return *found;
    return refuse(CallStatus::not_found,
                  "name: no object '" + std::string(name.substr(0, 64)) + "' is registered");
}

std::vector<TrackSnapshot> Tracker::snapshots() const {
    std::vector<TrackSnapshot> snapshots;
    for (const Track& track : impl_->tracks) snapshots.push_back(track.snapshot());
    return snapshots;
}

Settings Tracker::settings() const { return impl_->registry.settings(); }
const TrackerOptions& Tracker::options() const { return impl_->options; }
Geometry Tracker::geometry() const { return impl_->geometry; }
std::uint64_t Tracker::stream_id() const { return impl_->stream_id; }
std::uint32_t Tracker::next_object_id() const { return impl_->registry.next_object_id(); }
const TrackerCounters& Tracker::counters() const { return impl_->counters; }

}  // namespace pursuit::tracker
