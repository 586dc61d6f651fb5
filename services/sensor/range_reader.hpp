// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "services/sensor/formats/event_reader.hpp"

namespace pursuit::sensor {

/// A part of a source: the events with start_us <= t_us < end_us, in the source's own time;
/// end_us 0: to its end.
struct TimeRange {
    std::int64_t start_us = 0;
    std::int64_t end_us = 0;
};

/// A range given in seconds, each rounded to the nearest us; an error where it is empty, negative
/// or beyond 9e12 s.
Result<TimeRange> range_of_seconds(double start_s, double end_s);

/// An error of the source before the range's end is an error of the range.
std::unique_ptr<EventReader> in_range(std::unique_ptr<EventReader> source, TimeRange range);

}  // namespace pursuit::sensor
