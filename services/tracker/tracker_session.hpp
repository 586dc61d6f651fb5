// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "events.h"
#include "services/common/clock.hpp"
#include "services/tracker/model_board.hpp"
#include "services/tracker/model_store.hpp"
#include "services/tracker/pose_publisher.hpp"
#include "services/tracker/scheduled_tracker.hpp"
#include "services/tracker/stream_follower.hpp"

namespace pursuit::tracker {

/// What the status tells of a session. Running totals since the start unless said otherwise.
struct SessionFigures {
    TrackerCounters tracker;
    StreamCounters stream;
    std::uint64_t dropped_bad_geometry = 0;  ///< Events in packets of another geometry.
    std::uint64_t requests = 0;
    std::uint64_t requests_refused = 0;
    std::uint64_t late_refusals = 0;  ///< Calls refused at their time after they were accepted.
    std::uint64_t poses_out = 0;
    std::uint64_t write_failures = 0;
    std::uint64_t stream_id = 0;
    std::int64_t last_t_us = -1;
    std::int64_t last_host_time_ns = 0;   ///< Of last_t_us; 0 before the first event.
    std::int64_t taken_host_time_ns = 0;  ///< When these figures were.
    bool stream_open = false;             ///< Begun and not ended.
    std::uint32_t calls_waiting = 0;      ///< For their time.
    std::uint32_t objects = 0;
    std::uint32_t objects_tracking = 0;
    std::uint32_t objects_lost = 0;
    double busy_fraction = 0;  ///< Processing time over event time, about the last second.
    v1::Percentiles latency;   ///< Of the last 5 to 10 s of this stream's poses.
};

/// Where a session's output goes. The writers say whether a sample was taken.
struct SessionOutputs {
    PosePublisher::WritePose pose;
    PosePublisher::WriteTrack track;
    ModelBoard::WriteModel model;
    ModelBoard::WriteSettings settings;
    ModelBoard::WriteModel forget_model;              ///< As ModelBoard's.
    std::function<void(std::uint32_t)> forget_poses;  ///< No pose of the object comes any more.
    std::function<v1::TrackerStatus(const SessionFigures&)> status;  ///< Asked for by a call.
    std::function<void(const std::string&)> error;                   ///< For log and status.
    PosePublisher::TellLoss loss;                                    ///< For the log.
    std::function<void(const std::string&)> remark;                  ///< For the log.
    std::function<bool()> may_go_on;  ///< Asked before each object at the start, which takes long.
};

/// Everything that the core thread does, in the order that it is given: packets to the tracker,
/// requests to the tracker at their time, results to the outputs. Knows no middleware. One thread.
class TrackerSession {
 public:
    /// `stored`: what a former run left. Its objects come back with their ids, and go on from their
    /// last poses (Tracker::resume). `models` are registered where no object of that name is there;
    /// what the store holds otherwise than they and the tracker's settings are is remarked.
    /// What cannot be restored is told to outputs.error and left out. Where outputs.may_go_on says
    /// no, it is left as it is then, !is_whole(), and not to be used or stored.
    TrackerSession(Tracker tracker, ServiceIdentity identity, std::optional<StoredState> stored,
                   const std::vector<Registration>& models, Clock& clock, SessionOutputs outputs);

    [[nodiscard]] bool is_whole() const { return is_whole_; }

    /// `packet` is used up.
    void take(v1::EventPacket& packet);

    /// Every call gets an answer. A refused one has an effective time of 0.
    v1::TrackerReply answer(v1::TrackerRequest& request);

    [[nodiscard]] SessionFigures figures() const;
    [[nodiscard]] StoredState stored_state() const;
    /// Of that state, without making it.
    [[nodiscard]] StoredMoment stored_moment() const;

    /// Counts the changes that the store has to keep at once: objects and settings, not poses.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }

 private:
    void restore(const StoredState& stored);
    void register_models(const std::vector<Registration>& models, const Settings& configured);
    void changed(const v1::TrackerCall& call);
    void forget_removed(std::size_t count);
    void tell_failed_writes();
    void note_busy(std::int64_t busy_ns, std::int64_t t_before_us);

    [[nodiscard]] bool may_go_on();

    ServiceIdentity identity_;
    Clock& clock_;
    SessionOutputs outputs_;
    ScheduledTracker tracker_;
    StreamFollower follower_;
    PosePublisher publisher_;
    ModelBoard board_;
    RequestedSettings requested_;
    StoredMoment restored_;
    bool is_whole_ = true;
    std::vector<Event> events_;          // kept between packets
    std::deque<std::uint32_t> removed_;  // of which poses may still come
    std::uint64_t told_failures_ = 0;
    std::int64_t told_failures_ns_ = 0;
    std::uint64_t dropped_bad_geometry_ = 0;
    std::uint64_t requests_ = 0;
    std::uint64_t requests_refused_ = 0;
    std::uint64_t late_refusals_ = 0;
    std::uint64_t revision_ = 0;
    // Busy time and event time of the second that is being measured.
    std::int64_t busy_ns_ = 0;
    std::int64_t busy_event_us_ = 0;
    double busy_fraction_ = 0;
};

}  // namespace pursuit::tracker
