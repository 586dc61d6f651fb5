// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/live_poses.hpp"

#include <cstdio>

#include "services/ctl/json_text.hpp"

namespace pursuit::ctl {
namespace {

using namespace std::chrono_literals;

std::string track_state_name(v1::TrackState state) {
    return std::string(tracker::to_string(static_cast<tracker::TrackState>(state)));
}

template <class Numbers>
std::string json_array(const Numbers& numbers) {
    std::string text = "[";
    for (const auto number : numbers) {
        if (text.size() > 1) text += ", ";
        text += std::isfinite(number) ? number_text(number) : "null";
    }
    return text + "]";
}

}  // namespace

PoseRow row_of(const v1::ObjectPose& pose) {
    PoseRow row;
    row.t_us = pose.t_us();
    row.last_event_t_us = pose.last_event_t_us();
    row.object_id = pose.object_id();
    row.model = pose.model().to_string();
    row.state = static_cast<tracker::TrackState>(pose.state());
    row.pose.t_px = {pose.x_px(), pose.y_px()};
    row.pose.a << pose.a00(), pose.a01(), pose.a10(), pose.a11();
    row.theta_rad = pose.theta_rad();
    row.scale_x = pose.scale_x();
    row.scale_y = pose.scale_y();
    row.vx_px_s = pose.vx_px_s();
    row.vy_px_s = pose.vy_px_s();
    row.omega_rad_s = pose.omega_rad_s();
    row.confidence = pose.confidence();
    row.residual_px = pose.mean_residual_px();
    return row;
}

std::string pose_json(const v1::ObjectPose& pose) {
    const auto transform = static_cast<tracker::TransformKind>(pose.transform());
    JsonObject json;
    json.add("sensor_id", pose.sensor_id())
        .add("object_id", pose.object_id())
        .add("stream_id", pose.stream_id())
        .add("sequence_number", pose.sequence_number())
        .add("t_us", pose.t_us())
        .add("last_event_t_us", pose.last_event_t_us())
        .add("host_time_ns", pose.host_time_ns())
        .add("model", pose.model().to_string())
        .add("transform", tracker::to_string(transform))
        .add("state", track_state_name(pose.state()))
        .add("x_px", pose.x_px())
        .add("y_px", pose.y_px())
        .add("a00", pose.a00())
        .add("a01", pose.a01())
        .add("a10", pose.a10())
        .add("a11", pose.a11())
        .add("theta_rad", pose.theta_rad())
        .add("scale_x", pose.scale_x())
        .add("scale_y", pose.scale_y())
        .add("vx_px_s", pose.vx_px_s())
        .add("vy_px_s", pose.vy_px_s())
        .add("omega_rad_s", pose.omega_rad_s())
        .add("scale_x_rate_per_s", pose.scale_x_rate_per_s())
        .add("scale_y_rate_per_s", pose.scale_y_rate_per_s())
        .raw("pose_covariance", json_array(pose.pose_covariance()))
        .raw("velocity_covariance", json_array(pose.velocity_covariance()))
        .add("confidence", pose.confidence())
        .add("mean_residual_px", pose.mean_residual_px())
        .add("event_rate_hz", pose.event_rate_hz())
        .add("events_used", pose.events_used());
    return json.text();
}

void PoseCounter::add(const v1::ObjectPose& pose) {
    ++poses_;
    std::uint64_t& last = last_[{pose.sensor_id(), pose.object_id()}];
    if (last != 0 && pose.sequence_number() > last + 1) {
        ++gaps_;
        missed_ += pose.sequence_number() - last - 1;
    }
    last = pose.sequence_number();
}

void PoseTable::add(const v1::ObjectPose& pose) {
    Entry& entry = objects_[{pose.sensor_id(), pose.object_id()}];
    entry.pose = pose;
    ++entry.count;
    changed_ = true;
}

bool PoseTable::due(std::chrono::steady_clock::time_point now) {
    if (!changed_ || now - drawn_ < (terminal_ ? 100ms : 1000ms)) return false;
    drawn_ = now;
    changed_ = false;
    return true;
}

std::string PoseTable::text() {
    std::string text;
    // Back to the first line of the table before, and clear from there (ECMA-48).
    if (terminal_ && lines_drawn_ > 0) text = "\033[" + std::to_string(lines_drawn_) + "A\033[J";
    char line[256];
    std::snprintf(line, sizeof line, "%-16s %4s %-9s %10s %9s %9s %8s %7s %9s %9s %6s %8s\n",
                  "model", "id", "state", "t [s]", "x [px]", "y [px]", "[deg]", "scale",
                  "vx [px/s]", "vy [px/s]", "conf", "poses");
    text += line;
    constexpr double degrees_per_rad = 57.29577951308232;
    for (const auto& [id, entry] : objects_) {
        const auto& pose = entry.pose;
        std::snprintf(
            line, sizeof line,
            "%-16.16s %4u %-9s %10.3f %9.2f %9.2f %8.1f %7.3f %9.1f %9.1f %6.2f %8llu\n",
            pose.model().c_str(), pose.object_id(), track_state_name(pose.state()).c_str(),
            static_cast<double>(pose.t_us()) * 1e-6, pose.x_px(), pose.y_px(),
            pose.theta_rad() * degrees_per_rad, pose.scale_x(), pose.vx_px_s(), pose.vy_px_s(),
            static_cast<double>(pose.confidence()), static_cast<unsigned long long>(entry.count));
        text += line;
    }
    lines_drawn_ = objects_.size() + 1;
    return text;
}

}  // namespace pursuit::ctl
