// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "events.h"
#include "services/tracker/work_queue.hpp"
#include "tracker_requests.h"

namespace pursuit::tracker {

using TrackerQueue = WorkQueue<v1::EventPacket, v1::TrackerRequest>;

/// What the listeners count. Threads: any.
struct IntakeCounters {
    std::atomic<std::uint64_t> dropped_packets{0};       ///< Pushed out of the full queue …
    std::atomic<std::uint64_t> dropped_events{0};        ///< … and the events in them.
    std::atomic<std::uint64_t> of_another_sensor{0};     ///< Packets; not queued.
    std::atomic<std::uint64_t> refused_requests{0};      ///< Because too many waited.
    std::atomic<std::uint64_t> left_packets{0};          ///< Waited still at the end …
    std::atomic<std::uint64_t> left_events{0};           ///< … with the events in them …
    std::atomic<std::uint64_t> left_requests{0};         ///< … and these.
    std::atomic<std::int64_t> last_packet_steady_ns{0};  ///< 0: none yet.
    std::atomic<bool> stream_ended{false};               ///< That packet was its stream's last.
};

/// A packet as it comes in: one of this sensor is queued, in the place of the oldest where the
/// queue is full; those of others take no room.
inline void take_in(v1::EventPacket& packet, std::uint32_t sensor_id, std::int64_t steady_ns,
                    TrackerQueue& queue, IntakeCounters& intake) {
    if (packet.sensor_id() != sensor_id) {
        intake.of_another_sensor.fetch_add(1);
        return;
    }
    intake.last_packet_steady_ns = steady_ns;
    intake.stream_ended = packet.end_of_stream();
    const auto dropped = queue.push_packet(std::move(packet));
    if (!dropped) return;
    intake.dropped_packets.fetch_add(1);
    intake.dropped_events.fetch_add(dropped->words().size());
}

}  // namespace pursuit::tracker
