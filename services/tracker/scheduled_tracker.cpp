// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/scheduled_tracker.hpp"

#include <algorithm>
#include <string>

#include "services/common/tracker_call_kinds.hpp"

namespace pursuit::tracker {
namespace {

/// Events that the tracker drops do not move time.
bool is_usable(const Event& event, Geometry geometry) {
    return event.t_us < max_t_us && event.x < geometry.width && event.y < geometry.height;
}

/// A call that waited comes to its time: what it reserved is its own now.
CallAnswer dispatch_due(Tracker& tracker, const v1::TrackerCall& call,
                        const ServiceIdentity& identity) {
    if (call._d() == v1::TRACKER_REGISTER_MODEL) {
        tracker.release_id(call.register_model().object_id());
    }
    return dispatch(tracker, call, identity);
}

}  // namespace

ScheduledTracker::Accepted ScheduledTracker::call(v1::TrackerCall& call, std::int64_t apply_at_us) {
    const std::int64_t now_us = tracker_.effective_time_us();
    if (!changes_tracker(call._d())) return {dispatch(tracker_, call, identity_), now_us};
    if (apply_at_us < 0 || apply_at_us >= max_t_us) {
        return {refusal(v1::STATUS_INVALID_ARGUMENT,
                        "apply_at_us: " + std::to_string(apply_at_us) + " is not within 0 to 2^53"),
                0};
    }
    if (apply_at_us > 0 && apply_at_us < now_us) {
        return {refusal(v1::STATUS_TOO_LATE, "apply_at_us: " + std::to_string(apply_at_us) +
                                                 " has been processed; at least " +
                                                 std::to_string(now_us) + " is wanted"),
                0};
    }
    if (apply_at_us > now_us) return schedule(call, apply_at_us);
    return {dispatch(tracker_, call, identity_), now_us};
}

ScheduledTracker::Accepted ScheduledTracker::schedule(v1::TrackerCall& call,
                                                      std::int64_t apply_at_us) {
    if (schedule_.full()) {
        return {refusal(v1::STATUS_LIMIT_EXCEEDED,
                        "apply_at_us: " + std::to_string(schedule_.capacity) +
                            " calls are waiting for their time, no more are taken"),
                0};
    }
    auto trial = trial_of(tracker_);
    if (!trial) return {refusal(v1::STATUS_FAILED, trial.error().message), 0};
    schedule_.each_until(apply_at_us, [&](std::int64_t, const v1::TrackerCall& before) {
        dispatch_due(*trial, before, identity_);
    });
    CallAnswer answer = dispatch(*trial, call, identity_);
    if (!answer.ok()) return {std::move(answer), 0};
    if (answer.changed && call._d() == v1::TRACKER_REGISTER_MODEL) {
        // It is told now, so that no other object may get it until then.
        const auto object_id = answer.result.register_model().object_id();
        call.register_model().object_id(object_id);
        tracker_.reserve_id(object_id);
    }
    answer.changed = false;  // not yet
    static_cast<void>(schedule_.push(apply_at_us, std::move(call)));
    return {std::move(answer), apply_at_us};
}

// Those that hold from effective_time_us() on are made before anything else is.
void ScheduledTracker::apply_due() {
    while (schedule_.next_us() <= tracker_.effective_time_us()) {
        const v1::TrackerCall call = schedule_.pop();
        const CallAnswer answer = dispatch_due(tracker_, call, identity_);
        if (on_applied_) on_applied_(call, answer);
    }
}

void ScheduledTracker::begin_stream(Geometry geometry, std::uint64_t stream_id,
                                    std::int64_t first_t_us) {
    tracker_.begin_stream(geometry, stream_id, first_t_us);
    apply_due();
}

void ScheduledTracker::process(std::span<const Event> events, PoseSink& sink) {
    while (schedule_.next_us() != schedule_.never) {
        const std::int64_t apply_at_us = schedule_.next_us();
        const auto first = std::find_if(events.begin(), events.end(), [&](const Event& event) {
            return event.t_us >= apply_at_us && is_usable(event, tracker_.geometry());
        });
        const auto before = static_cast<std::size_t>(first - events.begin());
        tracker_.process(events.first(before), sink);
        events = events.subspan(before);
        if (!events.empty()) tracker_.advance(apply_at_us - 1, sink);
        apply_due();
        if (events.empty()) return;
    }
    tracker_.process(events, sink);
}

void ScheduledTracker::advance(std::int64_t t_us, PoseSink& sink) {
    if (t_us >= max_t_us) return;
    while (schedule_.next_us() <= t_us) {
        tracker_.advance(schedule_.next_us() - 1, sink);
        apply_due();
    }
    tracker_.advance(t_us, sink);
    apply_due();
}

}  // namespace pursuit::tracker
