// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_session.hpp"

#include <algorithm>
#include <utility>

#include "services/sensor/packed_event.hpp"
#include "services/tracker/store_differences.hpp"
#include "services/tracker/tracker_wire.hpp"

namespace pursuit::tracker {
namespace {

constexpr std::int64_t busy_window_us = 1'000'000;

/// Failed writes are told no more often: there may be one with every pose.
constexpr std::int64_t failures_told_every_ns = 10'000'000'000;

PacketHeader header_of(const v1::EventPacket& packet) {
    return {packet.stream_id(),    packet.sequence_number(),          packet.base_time_us(),
            packet.host_time_ns(), {packet.width(), packet.height()}, packet.end_of_stream()};
}

void keep(std::vector<NamedValue>& kept, const NamedValue& value) {
    const auto known = std::find_if(kept.begin(), kept.end(),
                                    [&](const NamedValue& k) { return k.name == value.name; });
    if (known == kept.end()) {
        kept.push_back(value);
    } else {
        known->value = value.value;
    }
}

}  // namespace

TrackerSession::TrackerSession(Tracker tracker, ServiceIdentity identity,
                               std::optional<StoredState> stored,
                               const std::vector<Registration>& models, Clock& clock,
                               SessionOutputs outputs)
    : identity_(std::move(identity)),
      clock_(clock),
      outputs_(std::move(outputs)),
      tracker_(std::move(tracker), identity_,
               [this](const v1::TrackerCall& call, const CallAnswer& answer) {
                   if (answer.changed) changed(call);
                   if (answer.ok()) return;
                   ++late_refusals_;
                   outputs_.error("a call that waited for its time is refused: " +
                                  answer.outcome.message().to_string());
               }),
      publisher_(identity_.sensor_id, clock, outputs_.pose, outputs_.track, outputs_.loss),
      board_(identity_, outputs_.model, outputs_.settings, outputs_.forget_model) {
    const Settings configured = tracker_.tracker().settings();
    if (stored) {
        restore(*stored);
        const auto different = differences(configured, stored->settings);
        if (!different.empty()) {
            outputs_.remark("requests of a former run hold over the configuration: " + different);
        }
    }
    register_models(models, configured);
    if (!is_whole_) return;
    board_.refresh(tracker_.tracker());
    tell_failed_writes();
}

void TrackerSession::register_models(const std::vector<Registration>& models,
                                     const Settings& configured) {
    for (const auto& model : models) {
        if (!may_go_on()) return;
        const auto& name = model.shape.name;
        if (const auto there = tracker_.tracker().object(name)) {
            const auto different = differences(model, *there, configured.new_objects);
            if (different.empty()) continue;
            outputs_.remark("model " + name +
                            " is as the store has it, not as the configuration: " + different +
                            "; remove it by request and start again to change that");
        } else if (const auto registered = tracker_.tracker().register_object(model); !registered) {
            outputs_.error("model " + name +
                           " of the configuration: " + registered.error().message);
        }
    }
}

bool TrackerSession::may_go_on() {
    if (is_whole_) is_whole_ = outputs_.may_go_on();
    return is_whole_;
}

void TrackerSession::restore(const StoredState& stored) {
    Tracker& tracker = tracker_.tracker();
    const auto tell = [&](const std::string& what, const auto& result) {
        if (!result) outputs_.error("the store's " + what + ": " + result.error().message);
    };
    requested_ = stored.settings;
    if (requested_.strategy) {
        tell("strategy",
             tracker.set_strategy(*requested_.strategy, requested_.strategy_parameters));
    }
    for (const auto& value : requested_.parameters) {
        tell("parameters", tracker.set_parameters("", std::span(&value, 1)));
    }
    for (const auto& [object, track] : stored.objects) {
        if (!may_go_on()) return;
        const auto registered =
            tracker.register_object({object.object_id, object.shape, object.transform,
                                     object.estimator, object.start, values(object.parameters)});
        tell("object " + object.shape.name, registered);
        if (!registered || !track) continue;
        tell("pose of object " + object.shape.name + " (it begins where it was registered)",
             tracker.resume(*track, stored.moment.stream_id));
    }
    restored_ = stored.moment;
}

void TrackerSession::take(v1::EventPacket& packet) {
    const PacketHeader header = header_of(packet);
    // Those that are removed within this packet may have poses up to then in the next.
    const std::size_t removed_before = removed_.size();
    bool is_past_removals = false;
    switch (follower_.take(header)) {
        case PacketFate::of_another_stream:
        case PacketFate::old:
            return;
        case PacketFate::bad_geometry:
            dropped_bad_geometry_ += packet.words().size();
            return;
        case PacketFate::begins_stream:
            publisher_.begin_stream();
            tracker_.begin_stream(header.geometry, header.stream_id, header.base_time_us);
            is_past_removals = true;
            break;
        case PacketFate::continues_stream:
            break;
    }
    const std::int64_t begin_ns = clock_.steady_ns();
    const std::int64_t t_before_us = tracker_.tracker().last_t_us();
    publisher_.packet(header.base_time_us, header.host_time_ns);
    events_.clear();
    for (const std::uint64_t word : packet.words()) {
        events_.push_back(sensor::unpack(word, header.base_time_us));
    }
    tracker_.process(events_, publisher_);
    // What follows is not before the base time of an empty packet.
    if (events_.empty()) tracker_.advance(header.base_time_us, publisher_);
    publisher_.flush_tracks();
    if (tracker_.tracker().last_t_us() > t_before_us) is_past_removals = true;
    if (is_past_removals) forget_removed(removed_before);
    tell_failed_writes();
    note_busy(clock_.steady_ns() - begin_ns, t_before_us);
}

void TrackerSession::note_busy(std::int64_t busy_ns, std::int64_t t_before_us) {
    busy_ns_ += busy_ns;
    const std::int64_t t_us = tracker_.tracker().last_t_us();
    if (t_before_us >= 0 && t_us > t_before_us) busy_event_us_ += t_us - t_before_us;
    if (busy_event_us_ < busy_window_us) return;
    busy_fraction_ = static_cast<double>(busy_ns_) * 1e-3 / static_cast<double>(busy_event_us_);
    busy_ns_ = 0;
    busy_event_us_ = 0;
}

v1::TrackerReply TrackerSession::answer(v1::TrackerRequest& request) {
    ++requests_;
    ScheduledTracker::Accepted accepted;
    if (request.call()._d() == v1::TRACKER_GET_STATUS) {
        accepted.answer.result.get_status(outputs_.status(figures()));
        accepted.effective_time_us = tracker_.tracker().effective_time_us();
    } else {
        const v1::TrackerCall call = request.call();
        const std::uint32_t next_id_before = tracker_.tracker().next_object_id();
        accepted = tracker_.call(request.call(), request.apply_at_us());
        if (accepted.answer.changed) {
            changed(call);
        } else if (tracker_.tracker().next_object_id() != next_id_before) {
            ++revision_;  // An id was given to who waits: not to another after a restart either.
        }
    }
    if (!accepted.answer.ok()) ++requests_refused_;
    v1::TrackerReply reply;
    reply.header().remote_exception(accepted.answer.remote_exception);
    reply.effective_time_us(accepted.answer.ok() ? accepted.effective_time_us : 0);
    reply.outcome(std::move(accepted.answer.outcome));
    reply.result(std::move(accepted.answer.result));
    return reply;
}

void TrackerSession::changed(const v1::TrackerCall& call) {
    ++revision_;
    if (call._d() == v1::TRACKER_SET_OCCLUSION_STRATEGY) {
        const auto& set = call.set_occlusion_strategy();
        requested_.strategy = strategy_of(set.strategy()).value();
        requested_.strategy_parameters = values_of(set.parameters()).value();
    } else if (call._d() == v1::TRACKER_SET_PARAMETERS &&
               call.set_parameters().name().to_string().empty()) {
        const auto set = values_of(call.set_parameters().parameters()).value();
        for (const auto& value : set) keep(requested_.parameters, value);
    }
    for (const auto object_id : board_.refresh(tracker_.tracker())) {
        publisher_.forget(object_id);
        removed_.push_back(object_id);
    }
    tell_failed_writes();
}

void TrackerSession::forget_removed(std::size_t count) {
    for (; count > 0; --count) {
        publisher_.forget(removed_.front());  // what came since
        outputs_.forget_poses(removed_.front());
        removed_.pop_front();
    }
}

void TrackerSession::tell_failed_writes() {
    const std::uint64_t failures = publisher_.failures() + board_.failures();
    if (failures == told_failures_) return;
    const std::int64_t now_ns = clock_.steady_ns();
    if (told_failures_ > 0 && now_ns - told_failures_ns_ < failures_told_every_ns) return;
    told_failures_ = failures;
    told_failures_ns_ = now_ns;
    outputs_.error("the middleware did not take " + std::to_string(failures) +
                   " samples of poses, models and settings so far");
}

SessionFigures TrackerSession::figures() const {
    const Tracker& tracker = tracker_.tracker();
    SessionFigures figures;
    figures.tracker = tracker.counters();
    figures.stream = follower_.counters();
    figures.dropped_bad_geometry = dropped_bad_geometry_;
    figures.requests = requests_;
    figures.requests_refused = requests_refused_;
    figures.late_refusals = late_refusals_;
    figures.poses_out = publisher_.poses();
    figures.write_failures = publisher_.failures() + board_.failures();
    figures.stream_id = follower_.stream_id();
    figures.last_t_us = tracker.last_t_us();
    if (figures.last_t_us >= 0) {
        figures.last_host_time_ns = publisher_.host_time_ns(figures.last_t_us);
    }
    figures.taken_host_time_ns = clock_.realtime_ns();
    figures.stream_open = follower_.is_open();
    figures.calls_waiting = static_cast<std::uint32_t>(tracker_.waiting());
    figures.objects = static_cast<std::uint32_t>(tracker.object_names().size());
    figures.objects_tracking = publisher_.objects_in(TrackState::tracking);
    figures.objects_lost = publisher_.objects_in(TrackState::lost);
    figures.busy_fraction = busy_fraction_;
    const auto latency = publisher_.latency();
    figures.latency.p50_us(latency.percentile_us(0.5));
    figures.latency.p90_us(latency.percentile_us(0.9));
    figures.latency.p99_us(latency.percentile_us(0.99));
    figures.latency.max_us(latency.max_us());
    figures.latency.samples(latency.samples());
    return figures;
}

StoredMoment TrackerSession::stored_moment() const {
    // Before the first packet the poses are still those of the stored stream.
    if (follower_.counters().streams == 0) return restored_;
    return {follower_.stream_id(), tracker_.tracker().last_t_us()};
}

StoredState TrackerSession::stored_state() const {
    const Tracker& tracker = tracker_.tracker();
    StoredState state;
    state.moment = stored_moment();
    state.next_object_id = tracker.next_object_id();
    state.settings = requested_;
    const std::vector<TrackSnapshot> tracks = tracker.snapshots();
    for (auto& object : tracker.objects()) {
        const auto track = std::find_if(tracks.begin(), tracks.end(), [&](const auto& snapshot) {
            return snapshot.object_id == object.object_id && snapshot.was_tracked;
        });
        std::optional<TrackSnapshot> last;
        if (track != tracks.end()) last = *track;
        state.objects.push_back({std::move(object), std::move(last)});
    }
    return state;
}

}  // namespace pursuit::tracker
