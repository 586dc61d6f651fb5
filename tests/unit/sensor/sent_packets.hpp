// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "services/sensor/publisher.hpp"

namespace pursuit::sensor {

/// The middleware as a test scripts it: keeps every packet, takes it or not.
struct SentPackets {
    std::vector<v1::EventPacket> events;
    std::vector<v1::EventPacket> exposures;
    std::vector<std::string> errors;
    std::function<bool(const v1::EventPacket&)> takes = [](const auto&) { return true; };
    std::function<bool()> acknowledges = [] { return true; };
    int waits = 0;  ///< For readers of events.

    StreamOutputs outputs() {
        return {{[this](v1::EventPacket& packet) {
                     events.push_back(packet);
                     return takes(packet);
                 },
                 [this](std::chrono::milliseconds) {
                     ++waits;
                     return acknowledges();
                 },
                 [] { return 0; }},
                {[this](v1::EventPacket& packet) {
                     exposures.push_back(packet);
                     return takes(packet);
                 },
                 [](std::chrono::milliseconds) { return true; }, [] { return 0; }},
                [this](const std::string& message) { errors.push_back(message); }};
    }
};

/// Events 1 us apart, their polarities in turn.
inline std::vector<Event> events_from(std::int64_t t_us, std::size_t count) {
    std::vector<Event> events;
    for (std::size_t i = 0; i < count; ++i, ++t_us) {
        events.push_back({t_us, 1, 1, static_cast<std::uint8_t>(i % 2)});
    }
    return events;
}

/// What came in less what went out: the sum of the causes.
inline std::uint64_t lost_events(const PublisherCounts& counts) {
    return std::accumulate(counts.filtered.begin(), counts.filtered.end(),
                           counts.events_unsent + counts.events_overtaken + counts.events_left);
}

inline std::vector<std::uint64_t> dropped_events(const std::vector<v1::EventPacket>& packets) {
    std::vector<std::uint64_t> dropped;
    for (const auto& packet : packets) dropped.push_back(packet.dropped_events());
    return dropped;
}

}  // namespace pursuit::sensor
