// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "config.pb.h"
#include "services/recorder/replay/flow_control.hpp"
#include "services/recorder/replay/replay_channel.hpp"
#include "services/recorder/replay/replay_pace.hpp"
#include "services/recorder/replay/replay_plan.hpp"
#include "services/recorder/replay/tracker_calls.hpp"

namespace pursuit::recorder {

/// The DDS side of a replay: a participant with the writers of the topics that are replayed, and
/// the clients of the trackers that are called. Threads: fill() and cancel() any, the rest one at a
/// time.
class ReplayOutlet {
 public:
    using OnError = FlowControl::OnError;

    /// Offers what the plan has of the topics that the configuration asks for. `pace` must outlive
    /// the outlet; once it is stopped nothing waits. `on_error` is called by send(), make() and
    /// settle() with what was lost or not made.
    static Result<std::unique_ptr<ReplayOutlet>> create(const disk::RecorderConfig& configuration,
                                                        const ReplayPlan& plan,
                                                        const ReplayPace& pace, OnError on_error);

    /// Nothing to send, nobody to call.
    bool empty() const { return channels_.empty() && !makes_calls_; }

    /// What is waited for, where fewer than `readers` are there for the events (or for what there
    /// is in place of them), or no tracker for the calls; empty when all are there.
    std::string missing(int readers);

    /// Null where the topic is not replayed.
    ReplayChannel* channel(const std::string& topic);

    /// Another pass begins.
    void restart() { flow_.restart(); }

    /// Sends one message, as soon as those who hear it can take it. hurried: as FlowControl has it.
    void send(ReplayChannel& channel, Payload& payload, std::int64_t source_time_ns,
              const SampleId& original, bool hurried);

    /// Makes a call. begins_stream: as TrackerCalls has it.
    void make(const PlannedCall& call, bool begins_stream);

    /// Waits until every reader has everything.
    void settle();

    /// Ends what make() and send() wait for.
    void cancel();

    /// Leaves DDS; the totals stay.
    void close();

    /// Adds the totals of topics and calls. `plan` is the one this was made of.
    void fill(v1::RecorderStatus& status, const ReplayPlan& plan) const;

 private:
    ReplayOutlet(const ReplayPace& pace, OnError on_error)
        : pace_(pace), on_error_(std::move(on_error)), flow_(pace_, on_error_) {}

    const ReplayPace& pace_;
    const OnError on_error_;
    FlowControl flow_;
    std::unique_ptr<Participant> participant_;
    std::unique_ptr<TrackerCalls> calls_;            ///< Null where calls are not to be replayed.
    bool makes_calls_ = false;                       ///< The plan has some.
    std::map<std::string, ReplayChannel> channels_;  ///< By topic; unchanged once created.
    std::atomic<std::uint64_t> calls_made_{0};
    std::atomic<std::uint64_t> calls_failed_{0};
};

}  // namespace pursuit::recorder
