// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/event_publisher.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <sstream>
#include <utility>
#include <vector>

#include "services/common/topics.hpp"
#include "services/sensor/source.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t events_per_read = 65536;

std::string range_text(const disk::SensorConfig& config) {
    std::ostringstream text;
    text << "start_s " << config.start_s() << " to ";
    if (config.end_s() == 0) {
        text << "its end";
    } else {
        text << "end_s " << config.end_s();
    }
    return text.str();
}

}  // namespace

EventPublisher::EventPublisher(const disk::SensorConfig& config, StreamOutputs outputs,
                               Pacer& pacer, Clock& clock, FilterSwitch& filters,
                               std::unique_ptr<EventReader> source)
    : config_(config),
      outputs_(std::move(outputs)),
      pacer_(pacer),
      filters_(filters),
      source_(std::move(source)),
      sender_(config, outputs_, pacer, clock, filters, counts_,
              [&pacer](std::int64_t t_us) { return pacer.host_time_ns(t_us); }) {}

void EventPublisher::start() {
    if (config_.wait_for_subscribers() == 0) state_ = State::running;
    // From here on requests for filters are judged by the size of the source's image.
    if (const auto chain = filters_.begin(source_->geometry())) {
        const auto size = (*chain)->geometry();
        counts_.size = static_cast<std::uint32_t>(size.width) << 16 | size.height;
    }
    thread_ = std::thread([this] { run(); });
}

void EventPublisher::stop() {
    stopping_ = true;
    pacer_.stop();
    if (thread_.joinable()) thread_.join();
}

void EventPublisher::run() {
    if (!wait_for_subscribers()) return;
    state_ = State::running;
    for (;;) {
        bool source_failed = false;
        const bool whole = send_stream(*source_, source_failed);
        sender_.end();
        sender_.farewell();
        if (!whole) return;
        if (!source_failed && source_->events_read() + source_->exposures_read() == 0) {
            source_failed = !may_be_empty();
        }
        if (source_failed) {
            state_ = State::failed;
            return;
        }
        if (!config_.loop()) break;
        auto next = open_source(config_);
        if (!next) {
            outputs_.error(next.error().message);
            state_ = State::failed;
            return;
        }
        source_ = std::move(*next);
        pacer_.restart();
    }
    state_ = State::finished;
}

bool EventPublisher::may_be_empty() const {
    const std::string what = source_name(config_) + ": has no event";
    if (config_.loop()) {
        outputs_.error(what + ", nothing to repeat");
        return false;
    }
    spdlog::warn("{}", what);
    return true;
}

std::string EventPublisher::remark() const {
    return state() == State::waiting ? std::to_string(config_.wait_for_subscribers()) +
                                           " subscriber(s) of " + topic::events
                                     : "";
}

bool EventPublisher::wait_for_subscribers() {
    const int wanted = static_cast<int>(config_.wait_for_subscribers());
    while (outputs_.events.readers() < wanted) {
        if (stopping_) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return !stopping_;
}

bool EventPublisher::send_stream(EventReader& source, bool& source_failed) {
    if (auto ok = sender_.begin(source.geometry()); !ok) {
        outputs_.error(ok.error().message);
        source_failed = true;
        return true;
    }
    // A source may have no events, but who names a part of it expects some there.
    bool owes_events = config_.start_s() != 0 || config_.end_s() != 0;
    std::vector<Event> events(events_per_read);
    std::vector<Event> exposures(source.has_exposures() ? events_per_read : 0);
    while (!stopping_) {
        const auto batch = source.read(events, exposures);
        if (!batch) {
            outputs_.error(batch.error().message);
            source_failed = true;
        }
        if (batch && batch->events + batch->exposures > 0) owes_events = false;
        if (batch && batch->at_end && owes_events) {
            outputs_.error(source_name(config_) + ": no event lies within " + range_text(config_));
            source_failed = true;
        }
        if (!batch || batch->at_end) return true;
        if (source.time_us() == 0 && batch->events + batch->exposures == 0) continue;
        if (!sender_.send(std::span(events).first(batch->events),
                          std::span(exposures).first(batch->exposures), source.time_us())) {
            return false;
        }
    }
    return false;
}

}  // namespace pursuit::sensor
