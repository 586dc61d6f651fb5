// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/event_publisher.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <vector>

#include "services/sensor/source.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t events_per_read = 65536;

/// As fast as possible means as fast as readers acknowledge: at most this many packets of the 64
/// that the writer keeps are on their way.
constexpr std::uint64_t packets_per_acknowledgement = 16;
const eprosima::fastrtps::Duration_t acknowledgement_time{0, 200'000'000};

/// After the last packet, so that leaving does not cut off what is being sent again.
const eprosima::fastrtps::Duration_t farewell_time{1, 0};

}  // namespace

EventPublisher::EventPublisher(const disk::SensorConfig& config, Writer<v1::EventPacket>& writer,
                               Pacer& pacer, Clock& clock, Health& health)
    : config_(config), writer_(writer), pacer_(pacer), clock_(clock), health_(health) {}

void EventPublisher::start(std::unique_ptr<EventReader> source) {
    if (config_.wait_for_subscribers() == 0) state_ = State::running;
    const auto size = source->geometry();
    counts_.size = static_cast<std::uint32_t>(size.width) << 16 | size.height;
    thread_ = std::thread([this, source = std::move(source)]() mutable { run(std::move(source)); });
}

void EventPublisher::stop() {
    stopping_ = true;
    pacer_.stop();
    if (thread_.joinable()) thread_.join();
}

void EventPublisher::run(std::unique_ptr<EventReader> source) {
    if (!wait_for_subscribers()) return;
    state_ = State::running;
    for (;;) {
        bool source_failed = false;
        if (!publish_stream(*source, source_failed)) return;
        writer_.wait_acknowledged(farewell_time);
        if (source_failed) {
            state_ = State::failed;
            return;
        }
        if (!config_.loop()) break;
        auto next = open_source(config_);
        if (!next) {
            health_.error(next.error().message);
            state_ = State::failed;
            return;
        }
        source = std::move(*next);
        pacer_.restart();
    }
    state_ = State::finished;
}

bool EventPublisher::wait_for_subscribers() {
    const int wanted = static_cast<int>(config_.wait_for_subscribers());
    while (writer_.matched() < wanted) {
        if (stopping_) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return !stopping_;
}

bool EventPublisher::publish_stream(EventReader& source, bool& source_failed) {
    sequence_number_ = 0;
    // Two starts never share a nanosecond of wall time.
    counts_.stream_id = static_cast<std::uint64_t>(clock_.realtime_ns());
    Packetizer packetizer({config_.packet_events(), config_.packet_us()});
    std::vector<Event> events(events_per_read);
    for (bool more = true; more;) {
        const auto count = source.read(events);
        if (!count) {
            health_.error(count.error().message);
            source_failed = true;
        }
        more = count && *count > 0;
        if (more) {
            counts_.events_in += *count;
            packetizer.push({events.data(), *count});
        } else {
            packetizer.finish();
        }
        while (const auto* batch = packetizer.next()) {
            if (!pacer_.wait_until(batch->complete_us) || !publish(*batch)) return false;
        }
    }
    return true;
}

bool EventPublisher::publish(const EventBatch& batch) {
    const auto size = counts_.size.load();
    packet_.sensor_id(config_.sensor_id());
    packet_.stream_id(counts_.stream_id);
    packet_.sequence_number(sequence_number_++);
    packet_.base_time_us(batch.base_time_us);
    packet_.host_time_ns(pacer_.host_time_ns(batch.base_time_us));
    packet_.width(static_cast<std::uint16_t>(size >> 16));
    packet_.height(static_cast<std::uint16_t>(size & 0xffff));
    packet_.end_of_stream(batch.end_of_stream);
    packet_.dropped_events(counts_.events_unsent);
    packet_.words(batch.words);
    if (writer_.write(packet_)) {
        counts_.events_out += batch.words.size();
    } else {
        counts_.events_unsent += batch.words.size();
        health_.error("a packet of " + std::to_string(batch.words.size()) +
                      " events could not be published");
    }
    ++counts_.packets_out;
    counts_.last_t_us = batch.complete_us;
    if (pacer_.rate() == 0 && sequence_number_ % packets_per_acknowledgement == 0) {
        await_acknowledgement();
    }
    return !stopping_;
}

void EventPublisher::await_acknowledgement() {
    if (!writer_.wait_acknowledged(acknowledgement_time)) {
        counts_.packets_unacknowledged += packets_per_acknowledgement;
        spdlog::warn("a reader has not acknowledged the last {} packets",
                     packets_per_acknowledgement);
    }
}

}  // namespace pursuit::sensor
