// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "services/common/event.hpp"

namespace pursuit::sensor {

/// One step that every event of a stream goes through.
///
/// Contract: what becomes of an event depends on it and on the events before it alone, neither on
/// the wall clock nor on how the stream is cut into spans. Order and times stay as they are; pixels
/// of events that pass lie within geometry(). One thread.
class Filter {
 public:
    virtual ~Filter() = default;

    /// Works on the next events in place: moves those that pass to the front, returns how many.
    virtual std::size_t apply(std::span<Event> events) = 0;

    /// The pixel array of the events that pass.
    virtual Geometry geometry() const = 0;

    /// Whether the pixel alone decides, without memory: exposure measurements then go through too.
    virtual bool by_pixel_alone() const { return false; }
};

/// Moves the events for which `passes` is true to the front, in order, without a branch on it.
template <class Passes>
std::size_t keep_if(std::span<Event> events, Passes passes) {
    std::size_t kept = 0;
    for (const Event event : events) {
        const bool pass = passes(event);
        events[kept] = event;
        kept += static_cast<std::size_t>(pass);
    }
    return kept;
}

}  // namespace pursuit::sensor
