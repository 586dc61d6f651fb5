// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "config.pb.h"
#include "services/common/health.hpp"
#include "services/common/writer.hpp"
#include "services/sensor/formats/event_reader.hpp"
#include "services/sensor/pacer.hpp"
#include "services/sensor/packetizer.hpp"

namespace pursuit::sensor {

/// What the publishing thread has done; running totals, read by the status.
struct PublisherCounts {
    std::atomic<std::uint64_t> events_in{0};
    std::atomic<std::uint64_t> events_out{0};
    std::atomic<std::uint64_t> packets_out{0};
    std::atomic<std::uint64_t> events_unsent{0};  ///< the middleware did not take their packet
    std::atomic<std::uint64_t> packets_unacknowledged{0};  ///< waited for in vain; see publish()
    std::atomic<std::uint64_t> stream_id{0};
    std::atomic<std::int64_t> last_t_us{0};
    std::atomic<std::uint32_t> size{0};  ///< width << 16 | height
};

/// Reads a source, cuts it into packets and publishes them at their pace, on a thread of its own.
///
///   waiting (for subscribers) ──► running ⇄ paused ──► finished | failed
///                                    └── loop: as a new stream ──┘
///
/// Threads: start() and stop() on one; the rest from any.
class EventPublisher {
 public:
    enum class State { waiting, running, finished, failed };

    EventPublisher(const disk::SensorConfig& config, Writer<v1::EventPacket>& writer, Pacer& pacer,
                   Clock& clock, Health& health);
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
    bool publish_stream(EventReader& source, bool& source_failed);
    bool publish(const EventBatch& batch);
    void await_acknowledgement();

    const disk::SensorConfig& config_;
    Writer<v1::EventPacket>& writer_;
    Pacer& pacer_;
    Clock& clock_;
    Health& health_;
    PublisherCounts counts_;
    std::atomic<State> state_{State::waiting};
    std::atomic<bool> stopping_{false};
    v1::EventPacket packet_;
    std::uint64_t sequence_number_ = 0;
    std::thread thread_;
};

}  // namespace pursuit::sensor
