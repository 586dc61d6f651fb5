// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/packetizer.hpp"

#include "services/sensor/packed_event.hpp"

namespace pursuit::sensor {

Packetizer::Packetizer(Limits limits) : limits_(limits) {
    batch_.words.reserve(limits_.packet_events);
}

EventBatch* Packetizer::next() {
    while (!events_.empty()) {
        const Event& event = events_.front();
        if (open_) {
            const auto end_us = batch_.base_time_us + limits_.packet_us;
            if (event.t_us >= end_us) return close(end_us);
        } else {
            if (known_us_ && event.t_us > *known_us_ + silence_us) {
                return empty(*known_us_ + silence_us);
            }
            batch_.base_time_us = event.t_us;
            batch_.end_of_stream = false;
            batch_.words.clear();
            open_ = true;
        }
        batch_.words.push_back(pack(event, batch_.base_time_us));
        last_t_us_ = event.t_us;
        known_us_ = event.t_us;
        events_ = events_.subspan(1);
        if (batch_.words.size() >= limits_.packet_events) return close(last_t_us_);
    }
    if (open_) {
        const auto end_us = batch_.base_time_us + limits_.packet_us;
        if (reached_us_ >= end_us) return close(end_us);
        if (flushing_ || finished_) return close(last_t_us_);
    } else if (reached_us_ >= 0) {
        if (!known_us_) return empty(reached_us_);
        if (reached_us_ > *known_us_ + silence_us) return empty(*known_us_ + silence_us);
    }
    flushing_ = false;
    if (!finished_ || ended_) return nullptr;
    ended_ = true;
    auto* batch = empty(known_us_ ? std::max(last_t_us_ + 1, *known_us_) : 0);
    batch_.end_of_stream = true;
    return batch;
}

EventBatch* Packetizer::close(std::int64_t complete_us) {
    open_ = false;
    batch_.complete_us = complete_us;
    return &batch_;
}

EventBatch* Packetizer::empty(std::int64_t base_time_us) {
    batch_.words.clear();
    batch_.end_of_stream = false;
    batch_.base_time_us = base_time_us;
    batch_.complete_us = base_time_us;
    known_us_ = base_time_us;
    return &batch_;
}

}  // namespace pursuit::sensor
