// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "services/common/event.hpp"
#include "services/common/result.hpp"

namespace pursuit::sensor {

/// A source of events, read from front to back: a decoder of a recording, or a scene.
///
/// Contract: t_us never decreases; x < width, y < height; polarity 0 or 1. What breaks it is an
/// error. Every good event before an error is delivered first, by calls that succeed; then the
/// error is returned by each further call. One thread.
class EventReader {
 public:
    virtual ~EventReader() = default;

    /// Of the pixel array; known as soon as the reader is open.
    virtual Geometry geometry() const = 0;

    /// Reads the next events into the front of `events` and returns how many, 0 only at the end
    /// (or where `events` is empty). An error names file, byte offset (or line) and cause.
    Result<std::size_t> read(std::span<Event> events) {
        if (error_) return tl::unexpected(*error_);
        if (events.empty()) return 0;
        auto [count, error] = decode(events);
        events_read_ += count;
        error_ = std::move(error);
        if (error_ && count == 0) return tl::unexpected(*error_);
        return count;
    }

    /// How many events read() has delivered.
    std::uint64_t events_read() const { return events_read_; }

 protected:
    struct Decoded {
        std::size_t count = 0;       ///< Good events at the front of the span.
        std::optional<Error> error;  ///< What came after them.
    };

    /// Fills `events` (never empty) as far as it can; neither events nor error: the end.
    virtual Decoded decode(std::span<Event> events) = 0;

 private:
    std::uint64_t events_read_ = 0;
    std::optional<Error> error_;
};

/// "car.dat: byte 93: cause".
inline Error error_at(const std::string& name, std::uint64_t byte, const std::string& cause) {
    return Error{name + ": byte " + std::to_string(byte) + ": " + cause};
}

}  // namespace pursuit::sensor
