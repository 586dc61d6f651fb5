// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "services/recorder/packet_fields.hpp"
#include "services/recorder/replay/planned_call.hpp"
#include "services/recorder/replay/sensor_streams.hpp"

namespace pursuit::recorder {

/// Says which of the planned calls are due when a replay comes to a packet: each before the first
/// packet of its sensor that reaches its stream and time. Threads: one.
class CallSchedule {
 public:
    struct DueCall {
        PlannedCall call;
        /// The packet that follows is the first of its stream and holds nothing before the call.
        bool begins_stream = false;
    };

    CallSchedule() = default;

    /// Those of each sensor in the order in which they are made.
    explicit CallSchedule(std::map<std::uint32_t, std::deque<PlannedCall>> calls)
        : left_(std::move(calls)) {}

    /// The calls to make before this packet of events is sent. Each is given once.
    std::vector<DueCall> take(const PacketFields& packet);

    /// Those that no packet has reached, sensor by sensor.
    std::vector<DueCall> take_rest();

 private:
    std::map<std::uint32_t, std::deque<PlannedCall>> left_;
    SensorStreams streams_;
};

}  // namespace pursuit::recorder
