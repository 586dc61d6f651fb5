// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/pose_publisher.hpp"

#include <algorithm>
#include <utility>

#include "services/tracker/tracker_wire.hpp"

namespace pursuit::tracker {

PosePublisher::PosePublisher(std::uint32_t sensor_id, Clock& clock, WritePose write_pose,
                             WriteTrack write_track, TellLoss tell_loss)
    : sensor_id_(sensor_id),
      clock_(clock),
      write_pose_(std::move(write_pose)),
      write_track_(std::move(write_track)),
      tell_loss_(std::move(tell_loss)) {
    sample_.sensor_id(sensor_id);
}

void PosePublisher::packet(std::int64_t base_time_us, std::int64_t host_time_ns) {
    packet_base_time_us_ = base_time_us;
    packet_host_time_ns_ = host_time_ns;
}

void PosePublisher::forget(std::uint32_t object_id) {
    const auto gone = objects_.find(object_id);
    if (gone == objects_.end()) return;
    if (!gone->second.updates.empty()) send_track(object_id, gone->second);
    objects_.erase(gone);
}

void PosePublisher::pose(const PoseRecord& record) {
    Object& object = objects_[record.object_id];
    object.state = record.state;
    see_loss(record, object);
    fill(sample_, record);
    sample_.sequence_number(++object.sequence_number);
    sample_.host_time_ns(host_time_ns(record.t_us));
    if (!write_pose_(sample_)) {
        ++failures_;
        return;
    }
    ++poses_;
    latency_.add((clock_.realtime_ns() - packet_host_time_ns_) / 1000, clock_.steady_ns());
}

void PosePublisher::see_loss(const PoseRecord& record, Object& object) {
    if (std::exchange(object.loss_cause, record.loss_cause) == record.loss_cause) return;
    if (record.loss_cause == LossCause::not_lost) return;
    constexpr std::int64_t every_us = 1'000'000;
    const bool is_told = object.loss_told_us > 0 && record.t_us >= object.loss_told_us &&
                         record.t_us - object.loss_told_us < every_us;
    if (is_told) return;
    object.loss_told_us = record.t_us;
    tell_loss_(record);
}

void PosePublisher::update(const UpdateRecord& record) {
    Object& object = objects_[record.object_id];
    object.stream_id = record.stream_id;
    v1::PoseUpdate update;
    update.t_us(record.t_us);
    update.x_px(record.pose.t_px.x());
    update.y_px(record.pose.t_px.y());
    update.a00(record.pose.a(0, 0));
    update.a01(record.pose.a(0, 1));
    update.a10(record.pose.a(1, 0));
    update.a11(record.pose.a(1, 1));
    object.updates.push_back(update);
    if (object.updates.size() >= max_updates) send_track(record.object_id, object);
}

void PosePublisher::flush_tracks() {
    for (auto& [object_id, object] : objects_) {
        if (!object.updates.empty()) send_track(object_id, object);
    }
}

void PosePublisher::send_track(std::uint32_t object_id, Object& object) {
    v1::PoseTrack track;
    track.sensor_id(sensor_id_);
    track.object_id(object_id);
    track.stream_id(object.stream_id);
    track.sequence_number(++object.track_sequence_number);
    track.updates(std::move(object.updates));
    object.updates.clear();
    if (!write_track_(track)) ++failures_;
}

std::uint32_t PosePublisher::objects_in(TrackState state) const {
    return static_cast<std::uint32_t>(
        std::count_if(objects_.begin(), objects_.end(),
                      [&](const auto& entry) { return entry.second.state == state; }));
}

}  // namespace pursuit::tracker
