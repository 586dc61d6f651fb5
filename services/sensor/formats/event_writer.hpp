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
    /// was written before. Refuses, from the first on, those that break the readers' contract
    /// (order of time, geometry, polarity); those before are written.
    Result<void> write(std::span<const Event> events, std::span<const Event> exposures = {}) {
        if (!exposures.empty() && !holds_exposures()) {
            return fail(name_ + ": this file holds no exposure measurements");
        }
        const auto until_us = last_t_us_;
        Result<void> ok;
        const auto good_events = check(events, "event ", events_, until_us, ok);
        const auto good_exposures = check(exposures, "exposure ", exposures_, until_us, ok);
        const auto written = encode(events.first(good_events), exposures.first(good_exposures));
        return written ? ok : written;
    }

    virtual Result<void> close() = 0;

    std::uint64_t events_written() const { return events_; }
    std::uint64_t exposures_written() const { return exposures_; }

 protected:
    EventWriter(std::string name, Geometry geometry)
        : name_(std::move(name)), geometry_(geometry) {}

    /// Both are good; exposures only where the file holds them.
    virtual Result<void> encode(std::span<const Event> events,
                                std::span<const Event> exposures) = 0;

    const std::string& name() const { return name_; }
    Geometry geometry() const { return geometry_; }

 private:
    /// Counts the good ones up to the first bad one, which makes `ok` an error.
    std::size_t check(std::span<const Event> block, const char* what, std::uint64_t& count,
                      std::int64_t earliest_us, Result<void>& ok) {
        for (std::size_t i = 0; i < block.size(); ++i) {
            const auto cause = fault(block[i], earliest_us);
            if (!cause.empty()) {
                ok = fail(name_ + ": " + what + std::to_string(count) + ": " + cause);
                return i;
            }
            earliest_us = block[i].t_us;
            if (earliest_us > last_t_us_) last_t_us_ = earliest_us;
            ++count;
        }
        return block.size();
    }

    std::string fault(const Event& event, std::int64_t earliest_us) const {
        if (event.t_us < earliest_us) {
            return "time goes back from " + std::to_string(earliest_us) + " to " +
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
