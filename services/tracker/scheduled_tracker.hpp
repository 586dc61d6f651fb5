// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "services/tracker/apply_schedule.hpp"
#include "services/tracker/call_dispatch.hpp"
#include "services/tracker/core/tracker.hpp"

namespace pursuit::tracker {

/// A tracker that does calls at the sensor time they name.
///
///   apply_at_us 0 ────────────────────────────────► done now, holds from effective_time_us()
///   apply_at_us at or before the last processed ──► STATUS_TOO_LATE
///   apply_at_us = effective_time_us() ────────────► done now
///   apply_at_us later ── tried on a copy, behind ──► waits; the batch of events is split exactly
///                        the calls waiting before     before the first at or after apply_at_us
///                        it; a refusal ends it here
///
/// A call that waits is answered when it is accepted; the id of an object that it registers is
/// reserved until then. If it is refused at its time all the same,
/// because other calls came between, nothing is changed and on_late_refusal is told. Calls that
/// wait when a stream ends wait on for that time of the next stream. Calls that change nothing are
/// answered at once whatever time they name. One thread.
class ScheduledTracker {
 public:
    struct Accepted {
        CallAnswer answer;
        std::int64_t effective_time_us = 0;
    };
    /// A change was made by a waiting call.
    using OnApplied = std::function<void(const v1::TrackerCall&, const CallAnswer&)>;

    ScheduledTracker(Tracker tracker, ServiceIdentity identity, OnApplied on_applied)
        : tracker_(std::move(tracker)),
          identity_(std::move(identity)),
          on_applied_(std::move(on_applied)) {}

    Accepted call(v1::TrackerCall& call, std::int64_t apply_at_us);

    void begin_stream(Geometry geometry, std::uint64_t stream_id, std::int64_t first_t_us = 0);
    void process(std::span<const Event> events, PoseSink& sink);
    void advance(std::int64_t t_us, PoseSink& sink);

    [[nodiscard]] const Tracker& tracker() const { return tracker_; }
    [[nodiscard]] Tracker& tracker() { return tracker_; }
    [[nodiscard]] std::size_t waiting() const { return schedule_.size(); }

 private:
    Accepted schedule(v1::TrackerCall& call, std::int64_t apply_at_us);
    void apply_due();

    Tracker tracker_;
    ServiceIdentity identity_;
    OnApplied on_applied_;
    ApplySchedule<v1::TrackerCall> schedule_;
};

}  // namespace pursuit::tracker
