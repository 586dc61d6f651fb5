// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "services/common/event.hpp"
#include "services/common/result.hpp"

namespace pursuit::sensor {

/// Writes events to a file, front to back. Every write is checked; the file is whole only when
/// close() has succeeded. One thread.
class EventWriter {
 public:
    virtual ~EventWriter() = default;

    /// Appends events; refuses, from the first on, those that break the readers' contract (order
    /// of time, geometry, polarity).
    Result<void> write(std::span<const Event> events) {
        for (std::size_t i = 0; i < events.size(); ++i) {
            if (auto ok = check(events[i]); !ok) {
                if (auto before = encode(events.first(i)); !before) return before;
                return ok;
            }
        }
        return encode(events);
    }

    virtual Result<void> close() = 0;

    std::uint64_t events_written() const { return events_; }

 protected:
    EventWriter(std::string name, Geometry geometry)
        : name_(std::move(name)), geometry_(geometry) {}

    virtual Result<void> encode(std::span<const Event> events) = 0;

    const std::string& name() const { return name_; }
    Geometry geometry() const { return geometry_; }

 private:
    Result<void> check(const Event& event) {
        const auto refuse = [&](const std::string& cause) {
            return fail(name_ + ": event " + std::to_string(events_) + ": " + cause);
        };
        if (event.t_us < last_t_us_) {
            return refuse("time goes back from " + std::to_string(last_t_us_) + " to " +
                          std::to_string(event.t_us) + " us");
        }
        if (event.x >= geometry_.width || event.y >= geometry_.height) {
            return refuse("pixel (" + std::to_string(event.x) + ", " + std::to_string(event.y) +
                          ") is outside " + std::to_string(geometry_.width) + "x" +
                          std::to_string(geometry_.height));
        }
        if (event.polarity > 1) {
            return refuse("polarity " + std::to_string(event.polarity) + " is not 0 or 1");
        }
        last_t_us_ = event.t_us;
        ++events_;
        return {};
    }

    std::string name_;
    Geometry geometry_;
    std::uint64_t events_ = 0;
    std::int64_t last_t_us_ = 0;  // no format holds times before 0
};

}  // namespace pursuit::sensor
