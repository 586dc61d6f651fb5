// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "services/common/event.hpp"
#include "services/common/result.hpp"

namespace pursuit::sensor {

/// Writes events to a file, front to back. Every write is checked; the file is whole only when
/// close() has succeeded. One thread.
class EventWriter {
 public:
    virtual ~EventWriter() = default;

    /// Whether write() takes exposure measurements (event_reader.hpp).
    virtual bool holds_exposures() const { return false; }

    /// Appends events and exposure measurements, each in order of time and none earlier than what
    /// was written before; of one time, events first. Refuses the first that breaks the readers'
    /// contract (order of time, geometry, polarity), or that the format cannot hold, and what comes
    /// after it; what comes before is written and counted.
    Result<void> write(std::span<const Event> events, std::span<const Event> exposures = {}) {
        if (!exposures.empty() && !holds_exposures()) {
            return fail(name_ + ": this file holds no exposure measurements");
        }
        while (!events.empty() || !exposures.empty()) {
            const bool is_exposure =
                events.empty() ||
                (!exposures.empty() && exposures.front().t_us < events.front().t_us);
            auto& next = is_exposure ? exposures : events;
            auto& count = is_exposure ? exposures_ : events_;
            if (const auto cause = fault(next.front()); !cause.empty()) {
                return fail(name_ + (is_exposure ? ": exposure " : ": event ") +
                            std::to_string(count) + ": " + cause);
            }
            if (auto ok = encode(next.front(), is_exposure); !ok) return ok;
            last_t_us_ = next.front().t_us;
            ++count;
            next = next.subspan(1);
        }
        return {};
    }

    virtual Result<void> close() = 0;

    std::uint64_t events_written() const { return events_; }
    std::uint64_t exposures_written() const { return exposures_; }

 protected:
    EventWriter(std::string name, Geometry geometry)
        : name_(std::move(name)), geometry_(geometry) {}

    /// Appends a good event; an exposure measurement only where the file holds them.
    virtual Result<void> encode(const Event& event, bool is_exposure) = 0;

    /// Of the last event or measurement written; 0 before the first.
    std::int64_t last_t_us() const { return last_t_us_; }

    const std::string& name() const { return name_; }
    Geometry geometry() const { return geometry_; }

 private:
    std::string fault(const Event& event) const {
        if (event.t_us < last_t_us_) {
            return "time goes back from " + std::to_string(last_t_us_) + " to " +
                   std::to_string(event.t_us) + " us";
        }
        if (event.x >= geometry_.width || event.y >= geometry_.height) {
            return "pixel (" + std::to_string(event.x) + ", " + std::to_string(event.y) +
                   ") is outside " + std::to_string(geometry_.width) + "x" +
                   std::to_string(geometry_.height);
        }
        if (event.polarity > 1) {
            return "polarity " + std::to_string(event.polarity) + " is not 0 or 1";
        }
        return {};
    }

    std::string name_;
    Geometry geometry_;
    std::uint64_t events_ = 0;
    std::uint64_t exposures_ = 0;
    std::int64_t last_t_us_ = 0;  // no format holds times before 0
};

}  // namespace pursuit::sensor
