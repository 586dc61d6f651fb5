// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "services/sensor/filters/filters.hpp"

namespace pursuit::sensor {

inline constexpr std::size_t most_filters = 16;  // in a chain; the wire's bound

/// How many events each kind of filter has dropped, in the order of filter_kinds(); running totals
/// that outlive a chain. Read from any thread.
using FilterCounts = std::array<std::atomic<std::uint64_t>, 9>;

/// The filters that a stream goes through, in order. One thread.
class FilterChain {
 public:
    /// For events of `input`. An error names the filter, its parameter and the bound.
    static Result<std::unique_ptr<FilterChain>> make(std::span<const FilterSetting> settings,
                                                     Geometry input);

    /// As make(), without events: what can be said before their size is known.
    static Result<void> check(std::span<const FilterSetting> settings);

    /// Works on the next events in place: moves those that pass to the front, returns how many,
    /// and counts each that does not.
    std::size_t apply(std::span<Event> events, FilterCounts& dropped);

    /// The same for exposure measurements, by those filters that look at pixels alone.
    std::size_t apply_to_exposures(std::span<Event> exposures);

    /// Of the events that pass.
    Geometry geometry() const { return geometry_; }

 private:
    struct Stage {
        std::size_t kind;
        std::unique_ptr<Filter> filter;
    };

    std::vector<Stage> stages_;
    Geometry geometry_;
};

}  // namespace pursuit::sensor
