// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "config.pb.h"
#include "services/common/clock.hpp"
#include "services/sensor/filter_switch.hpp"
#include "services/sensor/pacer.hpp"
#include "services/sensor/packetizer.hpp"
#include "services/sensor/stream_outputs.hpp"

namespace pursuit::sensor {

/// What the publishing thread has done; running totals, read by the status.
struct PublisherCounts {
    std::atomic<std::uint64_t> events_in{0};
    std::atomic<std::uint64_t> events_out{0};
    std::atomic<std::uint64_t> exposures_out{0};
    std::atomic<std::uint64_t> packets_out{0};
    std::atomic<std::uint64_t> events_unsent{0};  ///< the middleware did not take their packet
    std::atomic<std::uint64_t> exposures_unsent{0};
    std::atomic<std::uint64_t> packets_unacknowledged{0};  ///< waited for in vain
    std::atomic<std::uint64_t> events_overtaken{0};  ///< of a live source, before they were sent
    std::atomic<std::uint64_t> exposures_overtaken{0};
    std::atomic<std::uint64_t> events_left{0};  ///< still to be sent when the sensor was stopped
    std::atomic<std::uint64_t> exposures_left{0};
    FilterCounts filtered{};
    std::atomic<std::uint64_t> stream_id{0};
    std::atomic<std::int64_t> last_t_us{0};
    std::atomic<std::uint32_t> size{0};  ///< width << 16 | height
};

/// Sends streams, one after another: filters their events, cuts them into packets, and writes these
/// at their pace. Exposure measurements go the same way beside them, on a topic of their own.
///
///   begin() ──► send() | flush(), again and again ──► end() ──► begin() …
///
/// What a packet says was dropped is what was lost: by overload, by the rate control, and because
/// the middleware did not take it; not what the other filters leave out on purpose.
/// Threads: one; pacer, filters and counts are used from others too.
class StreamSender {
 public:
    using HostTime = std::function<std::int64_t(std::int64_t t_us)>;

    /// `host_time` gives CLOCK_REALTIME of a sensor time. Everything must outlive the sender.
    StreamSender(const disk::SensorConfig& config, const StreamOutputs& outputs, Pacer& pacer,
                 Clock& clock, FilterSwitch& filters, PublisherCounts& counts, HostTime host_time);

    /// Whether a packet now and then waits for its readers: for sources that can wait.
    void await_readers(bool wanted) { awaits_readers_ = wanted; }

    /// A new stream begins; refused where the filters do not fit its size.
    Result<void> begin(Geometry input);

    /// Sends what came next, each in order of time; changes it in place. Nothing that follows is
    /// earlier than `reached_us`. False when the pacer was stopped: what is not sent is counted.
    bool send(std::span<Event> events, std::span<Event> exposures, std::int64_t reached_us);

    /// Sends what waits for its packet to be full.
    bool flush();

    /// Sends the rest, and that the stream has ended; after the pacer's stop at once.
    void end();

    /// Waits for the readers, so that leaving does not cut off what is being sent again.
    void farewell();

    bool in_stream() const { return events_packets_.has_value(); }

 private:
    void open(std::unique_ptr<FilterChain> chain);
    void send_slice(std::span<Event> events, std::span<Event> exposures, std::int64_t reached_us);
    void write_batches();
    void cut();
    void write(EventBatch& batch, const PacketOutput& output, std::uint64_t& sequence);
    void await_acknowledgement();
    std::uint64_t lost_events() const;
    std::uint64_t lost_exposures() const;

    const disk::SensorConfig& config_;
    const StreamOutputs& outputs_;
    Pacer& pacer_;
    Clock& clock_;
    FilterSwitch& filters_;
    PublisherCounts& counts_;
    HostTime host_time_;
    bool awaits_readers_ = true;

    // Of the stream.
    std::unique_ptr<FilterChain> chain_;
    std::optional<Packetizer> events_packets_;
    std::optional<Packetizer> exposures_packets_;  // from the first measurement on
    std::uint64_t events_sequence_ = 0;
    std::uint64_t exposures_sequence_ = 0;
    std::uint64_t lost_events_before_ = 0;  // when the stream began
    std::uint64_t lost_exposures_before_ = 0;

    v1::EventPacket packet_;
    std::uint64_t packets_ = 0;
};

}  // namespace pursuit::sensor
