// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

namespace pursuit::sensor {

/// CLOCK_REALTIME as a function of a live sensor's own time, from when its events arrive.
///
/// Arrival is the event's time and a delay that is never negative. So of each second of host time
/// the sample with the least delay is kept, for the last 64 of them; the rate of the sensor's clock
/// is the least-squares slope through these, and the map is the highest line of that slope with no
/// sample below it. What remains is the least delay of the way here, which cannot be observed.
///
/// A host clock that was set (its step shows against the steady clock) begins the map anew.
/// Threads: any.
class HostTimeMap {
 public:
    /// Events up to sensor time t_us have arrived at this time of the two clocks.
    void add(std::int64_t t_us, std::int64_t realtime_ns, std::int64_t steady_ns);

    /// Another stream begins: sensor time starts again.
    void restart();

    /// CLOCK_REALTIME of sensor time t_us; nothing before the first sample.
    std::optional<std::int64_t> host_time_ns(std::int64_t t_us) const;

    /// How much faster than CLOCK_REALTIME the sensor's clock runs; 0 until 4 s are seen.
    double drift_ppm() const;

 private:
    struct Sample {
        std::int64_t t_us = 0;
        std::int64_t offset_ns = 0;  // realtime less sensor time
    };
    static constexpr std::int64_t second_ns = 1'000'000'000;
    static constexpr std::size_t most_seconds = 64;
    static constexpr std::size_t least_seconds = 4;

    void fit();

    mutable std::mutex mutex_;
    std::deque<Sample> least_;     // one a second, the last still filling
    std::int64_t begin_ns_ = 0;    // of the last one's second, steady
    std::int64_t steady_ns_ = 0;   // of the last add()
    std::int64_t between_ns_ = 0;  // realtime less steady, then
    double slope_ = 0;             // ns of offset a µs of sensor time
    std::int64_t reference_us_ = 0;
    double intercept_ns_ = 0;  // offset of the line at reference_us_, less base_ns_
    std::int64_t base_ns_ = 0;
};

}  // namespace pursuit::sensor
