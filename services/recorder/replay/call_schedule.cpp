// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/call_schedule.hpp"

#include <utility>

namespace pursuit::recorder {

std::vector<CallSchedule::DueCall> CallSchedule::take(const PacketFields& packet) {
    const bool begins_stream = streams_.take(packet.sensor_id(), packet.stream_id());
    std::vector<DueCall> due;
    const auto found = left_.find(packet.sensor_id());
    if (found == left_.end()) return due;
    const auto stream = streams_.current(packet.sensor_id());
    for (auto& calls = found->second; !calls.empty(); calls.pop_front()) {
        auto& call = calls.front();
        const auto apply_at_us = call.request.apply_at_us();
        const bool is_due =
            call.stream < stream || (call.stream == stream && apply_at_us <= packet.reached_us());
        if (!is_due) break;
        const bool before_all = call.stream < stream || apply_at_us <= packet.first_us();
        due.push_back({std::move(call), begins_stream && before_all});
    }
    return due;
}

std::vector<CallSchedule::DueCall> CallSchedule::take_rest() {
    std::vector<DueCall> rest;
    for (auto& [sensor_id, calls] : left_) {
        for (auto& call : calls) rest.push_back({std::move(call), false});
    }
    left_.clear();
    return rest;
}

}  // namespace pursuit::recorder
