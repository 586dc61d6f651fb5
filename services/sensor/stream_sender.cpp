// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/stream_sender.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace pursuit::sensor {
namespace {

/// How much goes through the filters at a time: what a request changes takes effect this soon.
constexpr std::size_t slice_events = 2048;
constexpr std::int64_t slice_us = 1000;

/// As fast as possible means as fast as readers acknowledge: at most this many packets of the 64
/// that the writer keeps are on their way.
constexpr std::uint64_t packets_per_acknowledgement = 16;
constexpr std::chrono::milliseconds acknowledgement_time{200};
constexpr std::chrono::milliseconds farewell_time{1000};

/// Takes from the front of `events` those before `end_us`, at most `most`.
std::span<Event> take_before(std::span<Event>& events, std::int64_t end_us, std::size_t most) {
    const auto near = events.first(std::min(events.size(), most));
    const auto end = std::partition_point(near.begin(), near.end(),
                                          [&](const Event& event) { return event.t_us < end_us; });
    const auto count = static_cast<std::size_t>(end - near.begin());
    events = events.subspan(count);
    return near.first(count);
}

}  // namespace

StreamSender::StreamSender(const disk::SensorConfig& config, const StreamOutputs& outputs,
                           Pacer& pacer, Clock& clock, FilterSwitch& filters,
                           PublisherCounts& counts, HostTime host_time)
    : config_(config),
      outputs_(outputs),
      pacer_(pacer),
      clock_(clock),
      filters_(filters),
      counts_(counts),
      host_time_(std::move(host_time)) {}

Result<void> StreamSender::begin(Geometry input) {
    auto chain = filters_.begin(input);
    if (!chain) return tl::unexpected(chain.error());
    open(std::move(*chain));
    return {};
}

void StreamSender::open(std::unique_ptr<FilterChain> chain) {
    chain_ = std::move(chain);
    events_packets_.emplace(Packetizer::Limits{config_.packet_events(), config_.packet_us()});
    exposures_packets_.reset();
    events_sequence_ = 0;
    exposures_sequence_ = 0;
    lost_events_before_ = lost_events();
    lost_exposures_before_ = lost_exposures();
    // Two starts never share a nanosecond of wall time.
    counts_.stream_id = static_cast<std::uint64_t>(clock_.realtime_ns());
    const auto size = chain_->geometry();
    counts_.size = static_cast<std::uint32_t>(size.width) << 16 | size.height;
}

bool StreamSender::send(std::span<Event> events, std::span<Event> exposures,
                        std::int64_t reached_us) {
    counts_.events_in += events.size();
    while (!events.empty() || !exposures.empty()) {
        if (pacer_.stopped()) {
            counts_.events_left += events.size();
            counts_.exposures_left += exposures.size();
            return false;
        }
        auto end_us = slice_us + std::min(events.empty() ? reached_us : events.front().t_us,
                                          exposures.empty() ? reached_us : exposures.front().t_us);
        const auto some = take_before(events, end_us, slice_events);
        if (some.size() == slice_events) end_us = some.back().t_us;
        const auto beside = take_before(exposures, end_us, exposures.size());
        const bool last = events.empty() && exposures.empty();
        send_slice(some, beside, last ? reached_us : std::min(end_us, reached_us));
    }
    send_slice({}, {}, reached_us);
    return !pacer_.stopped();
}

void StreamSender::send_slice(std::span<Event> events, std::span<Event> exposures,
                              std::int64_t reached_us) {
    if (auto next = filters_.take()) {
        if (next->geometry() == chain_->geometry()) {
            chain_ = std::move(next);
        } else {
            // Readers rely on one size of image within a stream.
            end();
            open(std::move(next));
        }
    }
    events_packets_->push(events.first(chain_->apply(events, counts_.filtered)));
    events_packets_->advance(reached_us);
    if (!exposures.empty() && !exposures_packets_) {
        exposures_packets_.emplace(
            Packetizer::Limits{config_.packet_events(), config_.packet_us()});
    }
    if (exposures_packets_) {
        exposures_packets_->push(exposures.first(chain_->apply_to_exposures(exposures)));
        exposures_packets_->advance(reached_us);
    }
    write_batches();
}

bool StreamSender::flush() {
    if (!in_stream()) return true;
    events_packets_->flush();
    if (exposures_packets_) exposures_packets_->flush();
    write_batches();
    return !pacer_.stopped();
}

void StreamSender::end() {
    if (!in_stream()) return;
    events_packets_->finish();
    if (exposures_packets_) exposures_packets_->finish();
    write_batches();
    events_packets_.reset();
    exposures_packets_.reset();
}

void StreamSender::farewell() {
    const auto at_most = pacer_.stopped() ? acknowledgement_time : farewell_time;
    outputs_.events.wait_acknowledged(at_most);
    outputs_.exposures.wait_acknowledged(at_most);
}

/// Every batch that is complete, of both topics in the order of their time.
void StreamSender::write_batches() {
    EventBatch* event = events_packets_->next();
    EventBatch* exposure = exposures_packets_ ? exposures_packets_->next() : nullptr;
    while (event != nullptr || exposure != nullptr) {
        if (exposure == nullptr ||
            (event != nullptr && event->complete_us <= exposure->complete_us)) {
            write(*event, outputs_.events, events_sequence_);
            event = events_packets_->next();
        } else {
            write(*exposure, outputs_.exposures, exposures_sequence_);
            exposure = exposures_packets_->next();
        }
    }
}

/// The pacer was stopped: the batch that is being filled is the last.
void StreamSender::cut() {
    counts_.events_left += events_packets_->cut();
    if (exposures_packets_) counts_.exposures_left += exposures_packets_->cut();
}

void StreamSender::write(EventBatch& batch, const PacketOutput& output, std::uint64_t& sequence) {
    if (!pacer_.wait_until(batch.complete_us)) cut();
    const bool of_events = &output == &outputs_.events;
    const auto size = counts_.size.load();
    packet_.sensor_id(config_.sensor_id());
    packet_.stream_id(counts_.stream_id);
    packet_.sequence_number(sequence++);
    packet_.base_time_us(batch.base_time_us);
    packet_.host_time_ns(host_time_(batch.base_time_us));
    packet_.width(static_cast<std::uint16_t>(size >> 16));
    packet_.height(static_cast<std::uint16_t>(size & 0xffff));
    packet_.end_of_stream(batch.end_of_stream);
    packet_.dropped_events(of_events ? lost_events() - lost_events_before_
                                     : lost_exposures() - lost_exposures_before_);
    packet_.words().swap(batch.words);
    const auto words = packet_.words().size();
    if (output.write(packet_)) {
        (of_events ? counts_.events_out : counts_.exposures_out) += words;
    } else {
        (of_events ? counts_.events_unsent : counts_.exposures_unsent) += words;
        outputs_.error("a packet of " + std::to_string(words) +
                       (of_events ? " events" : " exposures") + " could not be published");
    }
    ++counts_.packets_out;
    counts_.last_t_us = batch.complete_us;
    if (awaits_readers_ && pacer_.rate() == 0 && ++packets_ % packets_per_acknowledgement == 0) {
        await_acknowledgement();
    }
}

std::uint64_t StreamSender::lost_exposures() const {
    return counts_.exposures_unsent + counts_.exposures_overtaken;
}

std::uint64_t StreamSender::lost_events() const {
    static const auto rate_control = *find_filter_kind("rate_control");
    return counts_.events_unsent + counts_.events_overtaken + counts_.filtered[rate_control];
}

void StreamSender::await_acknowledgement() {
    if (!outputs_.events.wait_acknowledged(acknowledgement_time) ||
        (exposures_packets_ && !outputs_.exposures.wait_acknowledged(acknowledgement_time))) {
        counts_.packets_unacknowledged += packets_per_acknowledgement;
        spdlog::warn("a reader has not acknowledged the last {} packets",
                     packets_per_acknowledgement);
    }
}

}  // namespace pursuit::sensor
