// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/common/event.hpp"

namespace pursuit::sensor {

/// One step of a live source, as it waits to be sent.
struct LiveItem {
    enum class Kind {
        begin,   ///< A stream begins: `geometry`.
        events,  ///< What arrived.
        end,     ///< It has ended; `fault` says why where it should not have.
    };
    Kind kind = Kind::events;
    Geometry geometry;
    std::string fault;

    std::vector<Event> events;     ///< In order of time.
    std::vector<Event> exposures;  ///< ATIS measurements, likewise.
    std::int64_t reached_us = 0;   ///< Sensor time up to which everything has arrived.
    std::int64_t host_ns = 0;      ///< CLOCK_REALTIME of that.

    /// What was dropped between the item before and this.
    std::uint64_t dropped_events = 0;
    std::uint64_t dropped_exposures = 0;
};

/// What lies between the thread that hears a live source and the one that sends: bounded, and where
/// it is full the oldest events make room for the newest. Begins and ends of streams are never
/// dropped, and each drop is counted. Threads: any.
class LiveQueue {
 public:
    /// Of events and measurements together.
    explicit LiveQueue(std::size_t capacity) : capacity_(capacity) {}

    void begin(Geometry geometry);
    /// Copies; events that follow one another soon share an item.
    void push(std::span<const Event> events, std::span<const Event> exposures,
              std::int64_t reached_us, std::int64_t host_ns);
    void end(std::string fault);
    /// Nothing follows: take() empties the queue, then has finished.
    void close();

    /// Waits up to `at_most` for an item; none when nothing came. `item` is reused.
    bool take(LiveItem& item, std::chrono::milliseconds at_most);

    /// Closed, and everything taken.
    bool finished() const;

    struct Totals {
        std::uint64_t dropped_events = 0;  ///< Because the queue was full.
        std::uint64_t dropped_exposures = 0;
        std::size_t waiting = 0;  ///< Events and measurements.
        std::size_t most_waiting = 0;
    };
    Totals totals() const;

 private:
    static constexpr std::size_t item_events = 8192;  // beyond it another item is begun
    static constexpr std::size_t most_streams = 64;   // that wait without an event

    static std::size_t size_of(const LiveItem& item) {
        return item.events.size() + item.exposures.size();
    }
    using Items = std::deque<LiveItem>;
    void add(LiveItem item);
    Items::iterator take_out(Items::iterator item);
    void make_room(std::size_t wanted);
    void forget_empty_streams();

    const std::size_t capacity_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    Items items_;
    Totals totals_;
    bool closed_ = false;
};

}  // namespace pursuit::sensor
