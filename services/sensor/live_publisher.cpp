// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/live_publisher.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <utility>

#include "services/common/topics.hpp"
#include "services/sensor/source.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::chrono::milliseconds flush_after{5};
constexpr std::int64_t noteworthy_silence_ns = 1'000'000'000;

}  // namespace

LivePublisher::LivePublisher(const disk::SensorConfig& config, StreamOutputs outputs, Pacer& pacer,
                             Clock& clock, FilterSwitch& filters, std::unique_ptr<LiveInput> input)
    : config_(config),
      outputs_(std::move(outputs)),
      pacer_(pacer),
      clock_(clock),
      sink_(config.live_buffer_events(), clock),
      input_(std::move(input)),
      sender_(config, outputs_, pacer, clock, filters, counts_,
              [this](std::int64_t t_us) { return tie_ns_ + (t_us - tie_us_) * 1000; }) {
    sender_.await_readers(false);
    sink_.waits_for(subscribers_wanted() > 0 ? std::to_string(subscribers_wanted()) +
                                                   " subscriber(s) of " + topic::events
                                             : source_name(config));
}

void LivePublisher::start() {
    sending_ = std::thread([this] { send(); });
}

void LivePublisher::stop() {
    stop_.raise();
    pacer_.stop();
    if (sending_.joinable()) sending_.join();
    if (hearing_.joinable()) hearing_.join();
    // What came and was not sent.
    for (LiveItem item; sink_.queue().take(item, std::chrono::milliseconds(0));) {
        count_dropped(item);
        counts_.events_in += item.events.size();
        counts_.events_left += item.events.size();
        counts_.exposures_left += item.exposures.size();
    }
}

void LivePublisher::hear() {
    input_->run(sink_, stop_);
    sink_.queue().close();
}

void LivePublisher::send() {
    if (!wait_for_subscribers()) return;
    hearing_ = std::thread([this] { hear(); });
    LiveItem item;
    while (!sink_.queue().finished()) {
        const bool came = sink_.queue().take(item, flush_after);
        if (!(came ? send(item) : sender_.flush())) break;
    }
    sender_.end();
    sender_.farewell();
    if (stop_.raised()) return;
    state_ = fault_.empty() ? State::finished : State::failed;
}

void LivePublisher::count_dropped(const LiveItem& item) {
    counts_.events_in += item.dropped_events;
    counts_.events_overtaken += item.dropped_events;
    counts_.exposures_overtaken += item.dropped_exposures;
}

bool LivePublisher::send(LiveItem& item) {
    count_dropped(item);
    switch (item.kind) {
        case LiveItem::Kind::begin: {
            tie_us_ = 0;
            tie_ns_ = clock_.realtime_ns();
            if (auto ok = sender_.begin(item.geometry); !ok) {
                outputs_.error(ok.error().message);
                return true;
            }
            spdlog::info("a stream of {}x{} pixels begins", item.geometry.width,
                         item.geometry.height);
            state_ = State::running;
            return true;
        }
        case LiveItem::Kind::events:
            if (!sender_.in_stream()) {
                counts_.events_in += item.events.size();
                unfiltered_ += item.events.size();
                return true;
            }
            tie_us_ = item.reached_us;
            tie_ns_ = item.host_ns;
            return sender_.send(item.events, item.exposures, item.reached_us);
        case LiveItem::Kind::end:
            fault_ = item.fault;
            if (!fault_.empty()) outputs_.error(fault_);
            state_ = State::waiting;
            sender_.end();
            return true;
    }
    return true;
}

bool LivePublisher::wait_for_subscribers() {
    while (outputs_.events.readers() < subscribers_wanted() && !stop_.raised()) {
        stop_.wait(-1, 0, std::chrono::milliseconds(5));
    }
    return !stop_.raised();
}

std::string LivePublisher::remark() const {
    if (state() == State::waiting) return sink_.waits_for();
    const auto silent_ns = sink_.silent_ns();
    return silent_ns < noteworthy_silence_ns
               ? ""
               : "silent for " + std::to_string(silent_ns / 1'000'000'000) + " s";
}

std::vector<std::pair<std::string, std::uint64_t>> LivePublisher::losses() const {
    return {{"live.queue_full", counts_.events_overtaken.load()},
            {"live.unusable", sink_.unusable() + unfiltered_.load()},
            {"live.lost_before", sink_.lost_before()}};
}

}  // namespace pursuit::sensor
