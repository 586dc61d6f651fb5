// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/sensor/publisher.hpp"
#include "tests/support/manual_clock.hpp"

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

/// A publisher that has sent all of its source and has ended: packets of 10 events, as fast as
/// possible.
template <class Publisher>
struct SentToItsEnd {
    SentToItsEnd() { config.set_packet_events(10); }

    template <class Source>
    void run(std::unique_ptr<Source> source) {
        std::promise<void> farewell;
        sent.acknowledges = [&] {
            farewell.set_value();
            return true;
        };
        publisher.emplace(config, sent.outputs(), pacer, clock, *filters, std::move(source));
        publisher->start();
        farewell.get_future().wait();
        publisher->stop();
    }

    disk::SensorConfig config;
    pursuit::test::ManualClock clock;
    Pacer pacer{clock, 0};
    std::unique_ptr<FilterSwitch> filters = std::move(*FilterSwitch::make({}));
    SentPackets sent;
    std::optional<Publisher> publisher;
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
