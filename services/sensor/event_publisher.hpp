// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "services/sensor/formats/event_reader.hpp"
#include "services/sensor/publisher.hpp"

namespace pursuit::sensor {

/// Sends what a reader gives: a recording, or a scene.
///
///   waiting (for subscribers) ──► running ⇄ paused ──► finished | failed
///                                    └── loop: as a new stream ──┘
class EventPublisher final : public Publisher {
 public:
    /// `source` is the first pass; a loop opens the next itself.
    EventPublisher(const disk::SensorConfig& config, StreamOutputs outputs, Pacer& pacer,
                   Clock& clock, FilterSwitch& filters, std::unique_ptr<EventReader> source);
    ~EventPublisher() override { stop(); }
    EventPublisher(const EventPublisher&) = delete;
    EventPublisher& operator=(const EventPublisher&) = delete;

    void start() override;
    void stop() override;
    std::string remark() const override;

 private:
    void run();
    bool wait_for_subscribers();
    /// Tells of a pass that gave nothing; a loop of such would spin.
    bool may_be_empty() const;
    /// One stream, all but its end; false when stopped. An error of the source ends the stream
    /// early.
    bool send_stream(EventReader& source, bool& source_failed);

    const disk::SensorConfig& config_;
    const StreamOutputs outputs_;
    Pacer& pacer_;
    FilterSwitch& filters_;
    std::unique_ptr<EventReader> source_;
    StreamSender sender_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace pursuit::sensor
