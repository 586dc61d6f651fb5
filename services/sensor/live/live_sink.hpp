// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <utility>

#include "services/common/clock.hpp"
#include "services/sensor/live/host_time_map.hpp"
#include "services/sensor/live/live_queue.hpp"

namespace pursuit::sensor {

/// What a live source hands its streams to, and says how it is. Streams come one after another:
/// begin(), push() again and again, end(). Threads: one at a time hands over; the rest from any.
class LiveSink {
 public:
    LiveSink(std::size_t queue_events, Clock& clock) : queue_(queue_events), clock_(clock) {}

    void begin(Geometry geometry);
    /// Events and measurements, each in order of time and within the geometry; nothing that follows
    /// is earlier than `reached_us`.
    void push(std::span<const Event> events, std::span<const Event> exposures,
              std::int64_t reached_us);
    /// `fault`: why, where it should not have ended, or why it could not begin; else empty.
    void end(const std::string& fault);

    /// How long the streams were that have ended since this was asked last. Of the thread that
    /// hands over.
    std::chrono::nanoseconds take_lasted() {
        return std::chrono::nanoseconds(std::exchange(lasted_ns_, 0));
    }

    /// Events that came and could not be used: their time is unknown, or they break the contract.
    void unusable(std::uint64_t events) { unusable_ += events; }
    /// Events that were lost before they came here, as the source itself counts them.
    void lost_before(std::uint64_t events) { lost_before_ += events; }

    /// What is waited for, for people; empty while a stream is there.
    void waits_for(const std::string& what);

    LiveQueue& queue() { return queue_; }
    const HostTimeMap& host_time() const { return host_time_; }
    std::string waits_for() const;
    std::uint64_t unusable() const { return unusable_.load(); }
    std::uint64_t lost_before() const { return lost_before_.load(); }
    std::uint64_t faults() const { return faults_.load(); }
    /// Since something arrived, ns; 0 where nothing is expected.
    std::int64_t silent_ns() const;

 private:
    LiveQueue queue_;
    Clock& clock_;
    HostTimeMap host_time_;
    std::int64_t begun_ns_ = 0;  ///< The stream, steady.
    std::int64_t lasted_ns_ = 0;
    std::atomic<std::uint64_t> unusable_{0};
    std::atomic<std::uint64_t> lost_before_{0};
    std::atomic<std::uint64_t> faults_{0};
    std::atomic<std::int64_t> heard_ns_{0};  // steady; 0 outside of streams
    mutable std::mutex mutex_;
    std::string waits_for_;
};

}  // namespace pursuit::sensor
