// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/stream_follower.hpp"

#include <algorithm>

#include "services/tracker/core/tracker_options.hpp"

namespace pursuit::tracker {

bool StreamFollower::was_left(std::uint64_t stream_id) const {
    return std::find(left_.begin(), left_.end(), stream_id) != left_.end();
}

PacketFate StreamFollower::begin(const PacketHeader& packet) {
    if (following_ && last_.stream_id != packet.stream_id) {
        left_.push_back(last_.stream_id);
        if (left_.size() > remembered_streams) left_.pop_front();
    }
    std::erase(left_, packet.stream_id);
    following_ = true;
    last_ = packet;
    ++counters_.packets;
    ++counters_.streams;
    return PacketFate::begins_stream;
}

PacketFate StreamFollower::take(const PacketHeader& packet) {
    if (!is_usable(packet.geometry)) {
        ++counters_.bad_geometry;
        return PacketFate::bad_geometry;
    }
    if (!following_) return begin(packet);
    if (packet.stream_id != last_.stream_id) {
        const bool replaces = !was_left(packet.stream_id) || last_.end_of_stream ||
                              packet.host_time_ns - last_.host_time_ns > abandoned_ns;
        if (replaces) return begin(packet);
        ++counters_.of_another_stream;
        return PacketFate::of_another_stream;
    }
    if (packet.sequence_number <= last_.sequence_number) {
        const bool again =
            packet.base_time_us < last_.base_time_us && packet.host_time_ns > last_.host_time_ns;
        if (again) return begin(packet);
        ++counters_.old;
        return PacketFate::old;
    }
    const std::uint64_t step = packet.sequence_number - last_.sequence_number;
    if (step > 1) {
        ++counters_.gaps;
        counters_.packets_missed += step - 1;
    }
    if (packet.geometry != last_.geometry) {
        // The sequence goes on; the events cannot be placed.
        const Geometry began_with = last_.geometry;
        last_ = packet;
        last_.geometry = began_with;
        ++counters_.bad_geometry;
        return PacketFate::bad_geometry;
    }
    last_ = packet;
    ++counters_.packets;
    return PacketFate::continues_stream;
}

}  // namespace pursuit::tracker
