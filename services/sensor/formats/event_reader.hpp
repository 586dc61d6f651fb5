// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "services/common/event.hpp"
#include "services/common/result.hpp"

namespace pursuit::sensor {

/// A source of events, read from front to back: a decoder of a recording or of a live stream of
/// bytes, or a scene.
///
/// Contract: t_us never decreases and is below 2^53; x < width, y < height; polarity 0 or 1. What
/// breaks it is an error. Every good event before an error is delivered first, by calls that
/// succeed; then the error is returned by each further call. One thread.
///
/// ATIS exposure measurements are Events whose polarity is the number of the threshold that was
/// crossed: 0 begins a measurement, 1 ends it; the grey level is proportional to 1/(t1 - t0).
/// Events and measurements of one call are each in order of time; nothing that a later call
/// delivers, event or measurement, is earlier than anything delivered before.
///
/// On a live source a call waits for bytes only while it has nothing to deliver.
class EventReader {
 public:
    /// What one call of read() delivered, at the front of each of its spans.
    struct Batch {
        std::size_t events = 0;
        std::size_t exposures = 0;
        /// The source has ended. Where it has not and there is neither event nor measurement,
        /// only time went on: time_us().
        bool at_end = false;
    };

    virtual ~EventReader() = default;

    /// Of the pixel array; known as soon as the reader is open.
    virtual Geometry geometry() const = 0;

    /// Whether the source may hold exposure measurements; known as soon as the reader is open.
    virtual bool has_exposures() const { return false; }

    /// Reads the next events and exposure measurements, until one of the spans is full or what has
    /// arrived is decoded. Where `exposures` is empty, measurements are passed over; where `events`
    /// is empty, nothing is read. An error names file, byte offset (or line) and cause.
    Result<Batch> read(std::span<Event> events, std::span<Event> exposures) {
        if (error_) return tl::unexpected(*error_);
        if (events.empty()) return Batch{};
        auto done = decode(events, exposures);
        const bool nothing = done.count == 0 && done.exposures == 0;
        events_read_ += done.count;
        exposures_read_ += done.exposures;
        events_skipped_ += done.skipped;
        time_us_ = std::max(time_us_, done.time_us);
        if (done.count > 0) time_us_ = std::max(time_us_, events[done.count - 1].t_us);
        if (done.exposures > 0) time_us_ = std::max(time_us_, exposures[done.exposures - 1].t_us);
        error_ = std::move(done.error);
        if (error_ && nothing) return tl::unexpected(*error_);
        return Batch{done.count, done.exposures, nothing && !done.goes_on};
    }

    /// The same for events alone: returns how many, 0 only at the end (or where `events` is empty).
    Result<std::size_t> read(std::span<Event> events) {
        for (;;) {
            const auto batch = read(events, {});
            if (!batch) return tl::unexpected(batch.error());
            if (batch->events > 0 || batch->at_end || events.empty()) return batch->events;
        }
    }

    /// Sensor time up to which everything has been delivered: of the last event or measurement, or
    /// later where the source tells its time without them.
    std::int64_t time_us() const { return time_us_; }

    /// How many events and measurements read() has delivered.
    std::uint64_t events_read() const { return events_read_; }
    std::uint64_t exposures_read() const { return exposures_read_; }

    /// How many events were passed over because nothing tells their time, or because they belong to
    /// another camera of the same file; each format says when.
    std::uint64_t events_skipped() const { return events_skipped_; }

 protected:
    struct Decoded {
        std::size_t count = 0;       ///< Good events at the front of their span.
        std::optional<Error> error;  ///< What came after them.
        std::size_t exposures = 0;   ///< Good measurements at the front of theirs.
        bool goes_on = false;        ///< Not the end, even where there is nothing to deliver.
        std::int64_t time_us = 0;    ///< Time that the source told beyond them; 0 for none.
        std::uint64_t skipped = 0;
    };

    /// Fills `events` (never empty) and `exposures` (empty: not wanted) as far as it can without
    /// waiting longer than for the first of them. Neither of them, nor an error, nor goes_on: the
    /// end.
    virtual Decoded decode(std::span<Event> events, std::span<Event> exposures) = 0;

 private:
    std::uint64_t events_read_ = 0;
    std::uint64_t exposures_read_ = 0;
    std::uint64_t events_skipped_ = 0;
    std::int64_t time_us_ = 0;
    std::optional<Error> error_;
};

/// "car.dat: byte 93: cause".
inline Error error_at(const std::string& name, std::uint64_t byte, const std::string& cause) {
    return Error{name + ": byte " + std::to_string(byte) + ": " + cause};
}

}  // namespace pursuit::sensor
