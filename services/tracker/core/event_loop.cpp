// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/event_loop.hpp"

#include <algorithm>
#include <utility>

#include "services/tracker/core/parameters.hpp"

namespace pursuit::tracker {
namespace {

constexpr std::int64_t round_us = 500;

// What is so near to one object's contour shows nothing of another.
constexpr double on_contour_px = 1;

// How far ahead of the event in hand the pixels of those to come are fetched from memory.
constexpr std::size_t prefetched = 16;

}  // namespace

EventLoop::EventLoop(const TrackerOptions& options, const Preset& preset)
    : emits_updates_(options.emit_updates),
      grid_(options.pose_rate_hz, options.max_poses_per_s),
      arbiter_(options.max_objects, preset.strategy, preset.strategy_parameters),
      tells_occlusion_(preset.tracker.tells_occlusion >= 0.5) {
    if (!options.only_checks) recent_.reserve(options.reserved);
}

void EventLoop::begin_stream(Geometry geometry, std::uint64_t stream_id, std::int64_t first_t_us) {
    // Nothing of the former stream comes any more.
    apply_changes();
    geometry_ = geometry;
    stream_id_ = stream_id;
    last_t_us_ = -1;
    grid_.restart();
    recent_.restart(geometry);
    seeker_.restart(geometry);
    arbiter_.restart();
    for (Track& track : tracks_) track.begin_stream(stream_id, first_t_us);
    restart_round();
}

void EventLoop::advance(std::int64_t t_us, PoseSink& sink) {
    if (t_us <= last_t_us_ || t_us >= max_t_us) return;
    reach(t_us, sink);
    last_t_us_ = t_us;
}

void EventLoop::hold(Change change) {
    changes_.push_back({effective_time_us(), std::move(change)});
    wake_us_ = 0;
    if (last_t_us_ < 0) apply_changes();
}

void EventLoop::apply_changes() {
    for (HeldChange& change : changes_) change.apply(*this);
    changes_.clear();
    occlusion_.restart();
    restart_round();
}

void EventLoop::add(const RegisteredObject& object, const TrackerParameters& tracker) {
    const auto place = std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& track) {
        return track.object_id() > object.object_id;
    });
    tracks_.insert(place, Track(object, tracker));
}

void EventLoop::remove(std::uint32_t object_id) {
    std::erase_if(tracks_, [&](const Track& track) { return track.object_id() == object_id; });
    forget(object_id);
}

void EventLoop::forget(std::uint32_t object_id) {
    arbiter_.forget(object_id);
    seeker_.forget(object_id);
}

void EventLoop::replace(const RegisteredObject& object) {
    if (Track* track = find(object.object_id)) track->replace(object);
    seeker_.forget(object.object_id);
}

Track* EventLoop::find(std::uint32_t object_id) {
    const auto found = std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& track) {
        return track.object_id() == object_id;
    });
    return found == tracks_.end() ? nullptr : &*found;
}

void EventLoop::set_tells_occlusion(bool tells) {
    tells_occlusion_ = tells;
    if (tells) return;
    for (Track& track : tracks_) track.show_all(last_t_us_);
}

// `now_us` begins: what was called for before it takes effect, in turn with the poses due.
void EventLoop::reach(std::int64_t now_us, PoseSink& sink) {
    while (!changes_.empty() && changes_.front().effective_time_us <= now_us) {
        emit_before(changes_.front().effective_time_us, sink);
        changes_.front().apply(*this);
        occlusion_.restart();
        restart_round();
        changes_.pop_front();
    }
    emit_before(now_us + 1, sink);
}

void EventLoop::emit_before(std::int64_t end_us, PoseSink& sink) {
    for (; grid_.next_us() < end_us; grid_.step()) {
        for (Track& track : tracks_) {
            if (!grid_.is_due(track.object_id(), tracks_.size())) {
                ++counters_.poses_thinned;
                continue;
            }
            PoseRecord record = track.record(grid_.next_us());
            record.stream_id = stream_id_;
            if (track.tells_of_loss(record.loss_cause)) {
                ++counters_.lost_by[static_cast<std::size_t>(record.loss_cause)];
            }
            sink.pose(record);
            ++counters_.poses_emitted;
        }
    }
}

bool EventLoop::accepts(const Event& event) {
    if (event.t_us < 0 || event.t_us >= max_t_us) {
        ++counters_.dropped_time_out_of_range;
        return false;
    }
    if (event.t_us < last_t_us_) {
        ++counters_.dropped_time_went_back;
        return false;
    }
    if (event.x >= geometry_.width || event.y >= geometry_.height) {
        ++counters_.dropped_outside_geometry;
        return false;
    }
    return true;
}

// What is done from time to time, before the first event at or after wake_us_.
void EventLoop::wake(std::int64_t t_us) {
    if (tells_occlusion_ && t_us >= occlusion_.next_us()) occlusion_.look(t_us, tracks_);
    // (What a search moves is entered in the map with the next round.)
    seeker_.work(t_us, tracks_, occlusion_);
    if (t_us >= next_round_us_) go_round(t_us);
    wake_us_ = std::min({grid_.next_us(), next_round_us_, seeker_.next_us()});
    if (tells_occlusion_) wake_us_ = std::min(wake_us_, occlusion_.next_us());
    if (!changes_.empty()) wake_us_ = std::min(wake_us_, changes_.front().effective_time_us);
}

// The event moves the pose of this track; false where it did not. (Always inlined, as the next:
// gcc would not, and it costs some twenty instructions an event.)
[[gnu::always_inline]] inline bool EventLoop::step(const Event& event, std::size_t index,
                                                   double weight, PoseSink& sink) {
    Track& track = tracks_[index];
    const bool is_taken = track.take(event, weight);
    // One that lost its grip is asked about events from farther away. (Among many none is asked
    // about what lies beside its circle: there even one event's leap counts.)
    if (!is_taken || track.is_to_be_placed() || reach_map_.is_crowded()) {
        reach_map_.place(index, track.reach(next_round_us_));
    }
    if (is_taken && emits_updates_) {
        sink.update({track.object_id(), stream_id_, event.t_us, track.pose()});
    }
    return is_taken;
}

// How near the event is to this object; null where it cannot be the object's.
[[gnu::always_inline]] inline const Approach* EventLoop::approach(const Event& event,
                                                                  std::size_t index,
                                                                  const PixelPast& past) {
    Track& track = tracks_[index];
    const Approach* const near = track.approach(event, past);
    // (How many tracks there are takes a division, so who needs it is asked for first.)
    if (near != nullptr && tells_occlusion_ && occlusion_.has_over(index) &&
        occlusion_.hides(index, event, tracks_)) {
        track.deny();
        return nullptr;
    }
    return near;
}

// The paper's algorithm, for one event.
[[gnu::always_inline]] inline void EventLoop::process(const Event& event, PoseSink& sink) {
    const PixelPast past = recent_.note(event);
    seeker_.see(event);

    // The objects it may belong to, by the nearest place of each model (3.1). Mostly there is none,
    // or one that nobody contends with.
    const ReachMap::Concerned concerned = reach_map_.at(event.x, event.y);
    const auto some = concerned.some();
    // (Both at once: by an event's place nobody could foresee two branches.)
    if ((some.count == 0) |
        ((some.count == 1) & !reach_map_.reaches(some.sole, event.x, event.y))) {
        ++counters_.events_unused;
        return;
    }
    if (some.count == 1 && !arbiter_.listens()) {
        const bool is_used =
            approach(event, some.sole, past) != nullptr && step(event, some.sole, 1, sink);
        ++(is_used ? counters_.events_used : counters_.events_unused);
        return;
    }
    arbiter_.begin();
    double nearest2_px2 = on_contour_px * on_contour_px;
    std::size_t nearest = tracks_.size();
    const auto for_each_reached = [&](const auto& ask) {
        concerned.for_each([&](std::size_t i) {
            if (reach_map_.reaches(i, event.x, event.y)) ask(i);
        });
    };
    for_each_reached([&](std::size_t i) {
        if (const Approach* const near = approach(event, i, past)) {
            arbiter_.claim(i, tracks_[i].object_id(), near->distance_px(), near->clutter,
                           near->is_weighed);
            if (near->contour2_px2 < nearest2_px2 && tracks_[i].is_followed()) {
                nearest2_px2 = near->contour2_px2;
                nearest = i;
            }
        }
    });
    if (arbiter_.count() == 0) {
        ++counters_.events_unused;
        return;
    }
    // What lies on the contour of one shows nothing of the others.
    if (nearest < tracks_.size()) {
        for_each_reached([&](std::size_t i) {
            if (i != nearest) tracks_[i].disown(event);
        });
    }

    // Whose it is (section 3.3), and the steps that follow from it (3.2).
    bool is_used = false;
    if (arbiter_.is_plain()) {
        is_used = step(event, arbiter_.claimant(0), 1, sink);
    } else {
        arbiter_.give(event, [&](std::size_t i) { return tracks_[i].likelihood(); });
        for (std::size_t i = 0; i < arbiter_.count(); ++i) {
            if (!(arbiter_.weight(i) > 0)) continue;
            if (!step(event, arbiter_.claimant(i), arbiter_.weight(i), sink)) continue;
            is_used = true;
            arbiter_.used(event, i);
        }
    }
    ++(is_used ? counters_.events_used : counters_.events_unused);
}

// Every track that it matters to learns what time it is, and the map where it is.
void EventLoop::go_round(std::int64_t t_us) {
    next_round_us_ = t_us + round_us;
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
        Track& track = tracks_[i];
        if (t_us < track.due_us()) continue;
        track.reach_time(t_us, recent_);
        reach_map_.place(i, track.reach(std::max(next_round_us_, track.due_us())));
    }
}

void EventLoop::restart_round() {
    reach_map_.restart(geometry_, tracks_.size());
    for (Track& track : tracks_) track.stir();
    next_round_us_ = 0;
    wake_us_ = 0;
}

void EventLoop::process(std::span<const Event> events, PoseSink& sink) {
    for (std::size_t i = 0; i < events.size(); ++i) {
        const Event& event = events[i];
        if (i + prefetched < events.size()) recent_.prefetch(events[i + prefetched]);
        ++counters_.events_in;
        if (!accepts(event)) continue;
        const bool is_due = event.t_us >= wake_us_;
        if (is_due) reach(event.t_us, sink);
        last_t_us_ = event.t_us;
        grid_.event_at(event.t_us);
        if (is_due) wake(event.t_us);
        process(event, sink);
    }
}

}  // namespace pursuit::tracker
