// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/filter_chain.hpp"

#include <utility>

namespace pursuit::sensor {
namespace {

Error at(std::size_t index, const FilterSetting& setting, const Error& error) {
    const std::string field = "filter[" + std::to_string(index) + "]";
    return {field + " " + setting.filter.substr(0, 64) + ": " + error.message, field};
}

}  // namespace

Result<void> FilterChain::check(std::span<const FilterSetting> settings) {
    if (settings.size() > most_filters) {
        return fail("filter has " + std::to_string(settings.size()) + " entries, at most " +
                    std::to_string(most_filters) + " are allowed");
    }
    for (std::size_t i = 0; i < settings.size(); ++i) {
        if (auto ok = check_filter(settings[i]); !ok) {
            return tl::unexpected(at(i, settings[i], ok.error()));
        }
    }
    return {};
}

Result<std::unique_ptr<FilterChain>> FilterChain::make(std::span<const FilterSetting> settings,
                                                       Geometry input) {
    if (auto ok = check(settings); !ok) return tl::unexpected(ok.error());
    auto chain = std::make_unique<FilterChain>();
    chain->geometry_ = input;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        auto filter = make_filter(settings[i], chain->geometry_);
        if (!filter) return tl::unexpected(at(i, settings[i], filter.error()));
        chain->geometry_ = (*filter)->geometry();
        chain->stages_.push_back({*find_filter_kind(settings[i].filter), std::move(*filter)});
    }
    return chain;
}

std::size_t FilterChain::apply(std::span<Event> events, FilterCounts& dropped) {
    for (auto& [kind, filter] : stages_) {
        const auto kept = filter->apply(events);
        if (kept != events.size()) {
            dropped[kind].fetch_add(events.size() - kept, std::memory_order_relaxed);
        }
        events = events.first(kept);
    }
    return events.size();
}

std::size_t FilterChain::apply_to_exposures(std::span<Event> exposures) {
    for (auto& [kind, filter] : stages_) {
        if (filter->by_pixel_alone()) exposures = exposures.first(filter->apply(exposures));
    }
    return exposures.size();
}

}  // namespace pursuit::sensor
