// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "config.pb.h"
#include "services/common/health.hpp"
#include "services/common/writer.hpp"
#include "services/sensor/formats/event_reader.hpp"
#include "services/sensor/pacer.hpp"
#include "services/sensor/stream_sender.hpp"

namespace pursuit::sensor {

/// Reads a source and sends its streams, on a thread of its own.
///
///   waiting (for subscribers) ──► running ⇄ paused ──► finished | failed
///                                    └── loop: as a new stream ──┘
///
/// Threads: start() and stop() on one; the rest from any.
class EventPublisher {
 public:
    enum class State { waiting, running, finished, failed };

    EventPublisher(const disk::SensorConfig& config, Writer<v1::EventPacket>& events,
                   Writer<v1::EventPacket>& exposures, Pacer& pacer, Clock& clock, Health& health,
                   FilterSwitch& filters);
    ~EventPublisher() { stop(); }
    EventPublisher(const EventPublisher&) = delete;
    EventPublisher& operator=(const EventPublisher&) = delete;

    /// `source` is the first pass; a loop opens the next itself.
    void start(std::unique_ptr<EventReader> source);
    void stop();

    State state() const { return state_.load(); }
    const PublisherCounts& counts() const { return counts_; }

 private:
    void run(std::unique_ptr<EventReader> source);
    bool wait_for_subscribers();
    /// One stream, to its end; false when stopped. An error of the source ends the stream early.
    bool send_stream(EventReader& source, bool& source_failed);

    const disk::SensorConfig& config_;
    Writer<v1::EventPacket>& events_;
    Pacer& pacer_;
    Health& health_;
    FilterSwitch& filters_;
    PublisherCounts counts_;
    StreamSender sender_;
    std::atomic<State> state_{State::waiting};
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace pursuit::sensor
