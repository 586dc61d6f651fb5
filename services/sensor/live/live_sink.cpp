// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/live/live_sink.hpp"

namespace pursuit::sensor {

void LiveSink::begin(Geometry geometry) {
    waits_for("");
    host_time_.restart();
    begun_ns_ = clock_.steady_ns();
    heard_ns_ = begun_ns_;
    queue_.begin(geometry);
}

void LiveSink::push(std::span<const Event> events, std::span<const Event> exposures,
                    std::int64_t reached_us) {
    const auto now_ns = clock_.steady_ns();
    heard_ns_ = now_ns;
    const auto realtime_ns = clock_.realtime_ns();
    host_time_.add(reached_us, realtime_ns, now_ns);
    queue_.push(events, exposures, reached_us,
                host_time_.host_time_ns(reached_us).value_or(realtime_ns));
}

void LiveSink::end(const std::string& fault) {
    // A fault may be told without a stream.
    if (heard_ns_.exchange(0) != 0) lasted_ns_ += clock_.steady_ns() - begun_ns_;
    if (!fault.empty()) ++faults_;
    queue_.end(fault);
}

void LiveSink::waits_for(const std::string& what) {
    const std::scoped_lock lock(mutex_);
    waits_for_ = what;
}

std::string LiveSink::waits_for() const {
    const std::scoped_lock lock(mutex_);
    return waits_for_;
}

std::int64_t LiveSink::silent_ns() const {
    const auto heard_ns = heard_ns_.load();
    return heard_ns == 0 ? 0 : clock_.steady_ns() - heard_ns;
}

}  // namespace pursuit::sensor
