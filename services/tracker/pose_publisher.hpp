// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "poses.h"
#include "services/common/clock.hpp"
#include "services/tracker/core/pose_record.hpp"
#include "services/tracker/latency_window.hpp"

namespace pursuit::tracker {

/// Turns what the tracker makes into samples: numbers the poses of each object, gives them the host
/// time of their sensor time, and measures how old their packet is. Knows no middleware: samples go
/// to two functions, which say whether they were taken. One thread.
class PosePublisher final : public PoseSink {
 public:
    using WritePose = std::function<bool(v1::ObjectPose&)>;
    using WriteTrack = std::function<bool(v1::PoseTrack&)>;

    /// For the log, each object at most once a second of event time: it is lost, and why.
    using TellLoss = std::function<void(const PoseRecord&)>;

    PosePublisher(std::uint32_t sensor_id, Clock& clock, WritePose write_pose,
                  WriteTrack write_track, TellLoss tell_loss);

    /// Of the packet whose events come next: the host time of its base time.
    void packet(std::int64_t base_time_us, std::int64_t host_time_ns);
    /// Latencies are those of one stream, of its last 5 to 10 s.
    void begin_stream() { latency_.clear(); }
    /// The object is gone; what was gathered of it is sent.
    void forget(std::uint32_t object_id);

    void pose(const PoseRecord& record) override;
    void update(const UpdateRecord& record) override;
    /// Sends the updates gathered so far.
    void flush_tracks();

    [[nodiscard]] std::int64_t host_time_ns(std::int64_t t_us) const {
        return packet_host_time_ns_ + (t_us - packet_base_time_us_) * 1000;
    }
    [[nodiscard]] std::uint64_t poses() const { return poses_; }
    [[nodiscard]] std::uint64_t failures() const { return failures_; }
    [[nodiscard]] LatencyHistogram latency() const { return latency_.both(); }
    /// How many objects were in this state in their last pose.
    [[nodiscard]] std::uint32_t objects_in(TrackState state) const;

    static constexpr std::size_t max_updates = 1000;  // PoseTrack, idl/poses.idl

 private:
    struct Object {
        std::uint64_t sequence_number = 0;
        std::uint64_t track_sequence_number = 0;
        TrackState state = TrackState::searching;
        LossCause loss_cause = LossCause::not_lost;
        std::int64_t loss_told_us = 0;
        std::uint64_t stream_id = 0;
        std::vector<v1::PoseUpdate> updates;
    };
    void see_loss(const PoseRecord& record, Object& object);
    void send_track(std::uint32_t object_id, Object& object);

    std::uint32_t sensor_id_;
    Clock& clock_;
    WritePose write_pose_;
    WriteTrack write_track_;
    TellLoss tell_loss_;
    std::int64_t packet_base_time_us_ = 0;
    std::int64_t packet_host_time_ns_ = 0;
    std::map<std::uint32_t, Object> objects_;
    v1::ObjectPose sample_;  // kept: 700 bytes a pose
    std::uint64_t poses_ = 0;
    std::uint64_t failures_ = 0;
    LatencyWindow latency_;
};

}  // namespace pursuit::tracker
