// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <map>
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
#include "services/recorder/packet_fields.hpp"
#include "services/recorder/replay/raw_writer.hpp"
#include "services/recorder/replay/replay_pace.hpp"
#include "services/recorder/replay/replay_plan.hpp"
#include "services/recorder/replay/tracker_calls.hpp"

namespace pursuit::recorder {

/// Replays a recording: publishes its packets at the pace of their log times, and makes the calls
/// that changed the tracker when it was recorded, each before the first packet that reaches its
/// time.
///
///   reading ─► waiting (for subscribers, for a tracker) ─► playing ⇄ paused ─► finished
///                                                             └── loop ──┘
///
/// A packet's payload stays as it was but for three fields: stream_id is another at each start,
/// because it is a new stream; host_time_ns is when the packet would be made now, and
/// recorded_host_time_ns what it was. Threads: one of its own.
class ReplayActivity final : public Activity {
 public:
    ReplayActivity(const disk::RecorderConfig& configuration, Health& health);
    ~ReplayActivity() override;

    /// Why a topic cannot be replayed; empty when it can.
    static std::string refusal_of(const std::string& topic);

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
    /// A topic that is replayed, with its running totals.
    struct Channel {
        std::unique_ptr<RawWriter> writer;
        bool packets = false;  ///< Its messages are EventPackets.
        std::atomic<std::uint64_t> messages{0};
        std::atomic<std::uint64_t> bytes{0};
        std::atomic<std::uint64_t> lost{0};  ///< Not taken by the middleware.
        std::size_t unacknowledged = 0;      ///< At most, since the last wait.
    };

    void run();
    Result<void> prepare();
    bool wait_for_peers();
    Result<void> play_once();
    Result<void> play(const mcap::MessageView& message, Channel& channel);
    void renew(Payload& payload, const PacketFields& packet, std::int64_t log_time_ns,
               const ReplayPace::Due& due);
    void make_calls(const PacketFields& packet);
    void make_call(const PlannedCall& call, bool begins_stream);
    void make_calls_left();
    void keep_room(Channel& channel, bool hurried);
    void wait_acknowledged(Channel& channel);
    void say(v1::ServiceState state, const std::string& line);
    void error(const std::string& message);

    const disk::RecorderConfig& configuration_;
    Health& health_;
    SystemClock clock_;
    ReplayPace pace_;
    std::unique_ptr<Participant> participant_;
    std::unique_ptr<TrackerCalls> calls_;      ///< Null where calls are not to be replayed.
    std::map<std::string, Channel> channels_;  ///< By topic; unchanged once prepared_.
    std::atomic<bool> prepared_{false};
    ReplayPlan plan_;

    // Of one pass.
    std::map<std::uint32_t, std::deque<PlannedCall>> calls_left_;
    std::map<std::uint32_t, std::vector<std::uint64_t>> streams_;  ///< By sensor, as recorded.
    std::map<std::uint64_t, std::uint64_t> new_stream_ids_;
    std::uint64_t next_stream_id_ = 0;
    std::size_t tracker_room_ = 0;

    std::atomic<std::uint64_t> calls_made_{0};
    std::atomic<std::uint64_t> calls_failed_{0};
    std::atomic<std::uint64_t> unacknowledged_{0};  ///< Waits that ended without.
    std::atomic<bool> finished_{false};
    std::atomic<bool> failed_{false};
    std::atomic<std::uint64_t> changes_{0};
    mutable std::mutex mutex_;
    v1::ServiceState state_ = v1::SERVICE_STARTING;
    std::string line_ = "reads the recording";
    std::thread thread_;
};

}  // namespace pursuit::recorder
