// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/tracker.hpp"

#include "services/tracker/core/event_loop.hpp"
#include "services/tracker/core/registry.hpp"

namespace pursuit::tracker {
namespace {

CallResult<void> check_range(std::string_view field, double value, double min, double max) {
    if (value >= min && value <= max) return {};
    return refuse(CallStatus::invalid_argument, std::string(field) + ": " + std::to_string(value) +
                                                    " is not within " + std::to_string(min) +
                                                    " to " + std::to_string(max));
}

}  // namespace

struct Tracker::Impl {
    Impl(TrackerOptions given, const Preset& preset)
        : options(std::move(given)),
          registry(options.max_objects, options.next_object_id, preset),
          loop(options, preset) {}

    [[nodiscard]] CallResult<void> has_room() const {
        if (loop.has_room()) return {};
        return refuse(CallStatus::limit_exceeded, std::to_string(EventLoop::most_held_changes) +
                                                      " calls wait for the next event");
    }

    void hold(EventLoop::Change change) {
        if (!options.only_checks) loop.hold(std::move(change));
    }

    TrackerOptions options;
    Registry registry;
    EventLoop loop;
};

CallResult<Tracker> Tracker::create(const TrackerOptions& options) {
    for (const auto& checked :
         {check_range("pose_rate_hz", options.pose_rate_hz, 1, 100'000),
          check_range("max_poses_per_s", options.max_poses_per_s, 1, 1e6),
          check_range("max_objects", options.max_objects, 1, 256),
          check_range("next_object_id", options.next_object_id, 1, no_object_id_left)}) {
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

void Tracker::begin_stream(Geometry geometry, std::uint64_t stream_id, std::int64_t first_t_us) {
    if (impl_->options.only_checks) return;
    impl_->loop.begin_stream(geometry, stream_id, first_t_us);
}

void Tracker::process(std::span<const Event> events, PoseSink& sink) {
    impl_->loop.process(events, sink);
}

void Tracker::advance(std::int64_t t_us, PoseSink& sink) { impl_->loop.advance(t_us, sink); }

std::int64_t Tracker::last_t_us() const { return impl_->loop.last_t_us(); }
std::int64_t Tracker::effective_time_us() const { return impl_->loop.effective_time_us(); }

CallResult<Registered> Tracker::register_object(const Registration& registration) {
    if (auto room = impl_->has_room(); !room) return tl::unexpected(room.error());
    auto registered = impl_->registry.add(registration, effective_time_us());
    if (!registered || registered->already_registered) return registered;
    impl_->hold([object = *impl_->registry.find(registered->object_id),
                 tracker = impl_->registry.settings().tracker](EventLoop& loop) {
        loop.add(object, tracker);
    });
    return registered;
}

void Tracker::reserve_id(std::uint32_t object_id) { impl_->registry.reserve_id(object_id); }
void Tracker::release_id(std::uint32_t object_id) { impl_->registry.release_id(object_id); }
void Tracker::take_ids_of(const Tracker& other) {
    impl_->registry.take_ids_of(other.impl_->registry);
}

CallResult<void> Tracker::update_object(const ObjectUpdate& update) {
    if (auto room = impl_->has_room(); !room) return tl::unexpected(room.error());
    auto replaced = impl_->registry.replace(update, effective_time_us());
    if (!replaced) return tl::unexpected(replaced.error());
    impl_->hold([object = **replaced](EventLoop& loop) { loop.replace(object); });
    return {};
}

CallResult<void> Tracker::remove_object(std::string_view name) {
    if (auto room = impl_->has_room(); !room) return tl::unexpected(room.error());
    auto removed = impl_->registry.remove(name);
    if (!removed) return tl::unexpected(removed.error());
    impl_->hold([object_id = *removed](EventLoop& loop) { loop.remove(object_id); });
    return {};
}

CallResult<void> Tracker::set_pose(std::string_view name, const Start& start) {
    if (auto room = impl_->has_room(); !room) return tl::unexpected(room.error());
    auto changed = impl_->registry.set_start(name, start, effective_time_us());
    if (!changed) return tl::unexpected(changed.error());
    impl_->hold([object = **changed](EventLoop& loop) {
        if (Track* track = loop.find(object.object_id)) track->restart(object);
        loop.forget(object.object_id);
    });
    return {};
}

CallResult<void> Tracker::resume(const TrackSnapshot& last, std::uint64_t stream_id) {
    if (auto room = impl_->has_room(); !room) return room;
    const RegisteredObject* object = impl_->registry.find(last.object_id);
    if (object == nullptr) {
        return refuse(CallStatus::not_found,
                      "object_id: no object " + std::to_string(last.object_id) + " is registered");
    }
    for (const auto& checked : {check(last.pose, object->transform), check(last.velocity)}) {
        if (checked) continue;
        return refuse(CallStatus::invalid_argument, "last." + checked.error().message);
    }
    impl_->hold([last, stream_id](EventLoop& loop) {
        if (Track* track = loop.find(last.object_id)) track->resume(last, stream_id);
    });
    return {};
}

CallResult<void> Tracker::set_strategy(StrategyKind kind, std::span<const NamedValue> parameters) {
    if (auto room = impl_->has_room(); !room) return tl::unexpected(room.error());
    auto changed = impl_->registry.set_strategy(kind, parameters, effective_time_us());
    if (!changed) return changed;
    impl_->hold([settings = impl_->registry.settings()](EventLoop& loop) {
        loop.set_strategy(settings.strategy, settings.strategy_parameters);
    });
    return {};
}

CallResult<void> Tracker::set_parameters(std::string_view name,
                                         std::span<const NamedValue> parameters) {
    if (auto room = impl_->has_room(); !room) return tl::unexpected(room.error());
    auto changed = impl_->registry.set_parameters(name, parameters, effective_time_us());
    if (!changed) return changed;
    // Without the shapes: in a silence many such calls wait.
    std::vector<std::pair<std::uint32_t, ObjectParameters>> of_objects;
    for (const RegisteredObject& object : impl_->registry.objects()) {
        of_objects.emplace_back(object.object_id, object.parameters);
    }
    impl_->hold([of_objects = std::move(of_objects),
                 tracker = impl_->registry.settings().tracker](EventLoop& loop) {
        loop.set_tells_occlusion(tracker.tells_occlusion >= 0.5);
        for (const auto& [object_id, of_one] : of_objects) {
            if (Track* track = loop.find(object_id)) track->set_parameters(of_one, tracker);
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
    for (const Track& track : impl_->loop.tracks()) {
        snapshots.push_back(track.snapshot(last_t_us()));
    }
    return snapshots;
}

Settings Tracker::settings() const { return impl_->registry.settings(); }
const TrackerOptions& Tracker::options() const { return impl_->options; }
Geometry Tracker::geometry() const { return impl_->loop.geometry(); }
std::uint64_t Tracker::stream_id() const { return impl_->loop.stream_id(); }
std::uint32_t Tracker::next_object_id() const { return impl_->registry.next_object_id(); }
const TrackerCounters& Tracker::counters() const { return impl_->loop.counters(); }

}  // namespace pursuit::tracker
