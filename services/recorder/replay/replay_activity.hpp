// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "config.pb.h"
#include "services/common/clock.hpp"
#include "services/common/health.hpp"
#include "services/recorder/activity.hpp"
#include "services/recorder/mcap/reader.hpp"
#include "services/recorder/replay/call_schedule.hpp"
#include "services/recorder/replay/clock_steps.hpp"
#include "services/recorder/replay/replay_outlet.hpp"
#include "services/recorder/replay/replay_pace.hpp"
#include "services/recorder/replay/replay_plan.hpp"
#include "services/recorder/replay/stream_renewal.hpp"

namespace pursuit::recorder {

/// Replays a recording: publishes its packets at the pace of their log times (but for
/// steps of the clock that those are of), and makes the calls
/// that changed the tracker when it was recorded, each before the first packet that reaches its
/// time.
///
///   reading ─► waiting (for subscribers, for a tracker) ─► playing ⇄ paused ─► finished
///                                                             └── loop ──┘
///
/// Threads: one of its own, which reads the file and sends.
class ReplayActivity final : public Activity {
 public:
    ReplayActivity(const disk::RecorderConfig& configuration, Health& health);
    ~ReplayActivity() override;
    /// Whether the file is there and a recording; damage further on shows as it is replayed.
    static Result<void> check(const std::string& path);

    Result<void> start() override;
    void tick() override {}
    bool finished() const override;
    bool failed() const override { return failed_.load(); }
    void stop() override;
    std::string status_line() const override;
    v1::ServiceState state() const override;
    std::uint64_t changes() const override { return changes_.load(); }
    void fill(v1::RecorderStatus& status) const override;
    Result<void> pause(bool paused) override;
    Result<void> set_rate(double rate) override;
    void new_file(Done done) override;

 private:
    void run();
    Result<void> prepare();
    void tell_plan();
    bool wait_for_peers();
    Result<void> play_once();
    void play(const mcap::MessageView& message, std::int64_t time_ns, ReplayChannel& channel);
    void make(const std::vector<CallSchedule::DueCall>& calls);
    void say(v1::ServiceState state, const std::string& line);
    void error(const std::string& message);

    const disk::RecorderConfig& configuration_;
    Health& health_;
    SystemClock clock_;
    ReplayPace pace_;
    ReplayPlan plan_;                       ///< Unchanged once prepared_.
    std::unique_ptr<ReplayOutlet> outlet_;  ///< There once prepared_.
    std::atomic<bool> prepared_{false};

    // Of one pass.
    CallSchedule schedule_;
    SteppedTime time_;
    StreamRenewal renewal_;

    std::atomic<bool> finished_{false};
    std::atomic<bool> failed_{false};
    std::atomic<std::uint64_t> changes_{0};
    mutable std::mutex mutex_;
    v1::ServiceState state_ = v1::SERVICE_STARTING;
    std::string line_ = "reads the recording";
    std::thread thread_;
};

}  // namespace pursuit::recorder
