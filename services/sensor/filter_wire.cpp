// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filter_wire.hpp"

#include <algorithm>

#include "services/sensor/filters/filter_chain.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t most_parameters = 16;    // idl/sensor_requests.idl
constexpr std::size_t longest_file = 255;      // likewise
constexpr std::size_t longest_parameter = 47;  // idl/models.idl, NamedValue

bool knows(const FilterKind& kind, std::string_view parameter) {
    return std::any_of(kind.parameters.begin(), kind.parameters.end(),
                       [&](const auto& known) { return known.name == parameter; });
}

}  // namespace

Result<std::vector<FilterSetting>> filters_of(const disk::SensorConfig& config) {
    std::vector<FilterSetting> settings;
    for (const auto& text : config.filter()) {
        auto setting = parse_filter(text);
        if (!setting) {
            return fail_field("filter[" + std::to_string(settings.size()) + "]",
                              ": " + setting.error().message);
        }
        settings.push_back(std::move(*setting));
    }
    return settings;
}

WireFilters filters_of(const v1::SetFilters& call) {
    WireFilters wanted;
    const auto refuse = [&](v1::StatusCode code, const std::string& message) {
        wanted.code = code;
        wanted.message = "field set_filters." + message;
        return wanted;
    };
    if (call.filters().size() > most_filters) {
        return refuse(v1::STATUS_LIMIT_EXCEEDED,
                      "filters has " + std::to_string(call.filters().size()) +
                          " entries, at most " + std::to_string(most_filters) + " are allowed");
    }
    const auto kinds = filter_kinds();
    for (const auto& filter : call.filters()) {
        const auto name = "filters[" + std::to_string(wanted.settings.size()) + "]";
        const auto kind = static_cast<std::size_t>(filter.kind());
        if (kind >= kinds.size()) {
            return refuse(v1::STATUS_NOT_FOUND, name + ".kind is " + std::to_string(kind) +
                                                    ", must be at most " +
                                                    std::to_string(kinds.size() - 1));
        }
        if (filter.parameters().size() > most_parameters) {
            return refuse(v1::STATUS_LIMIT_EXCEEDED,
                          name + ".parameters has " + std::to_string(filter.parameters().size()) +
                              " entries, at most " + std::to_string(most_parameters) +
                              " are allowed");
        }
        FilterSetting setting{std::string(kinds[kind].name), filter.file().to_string(), {}};
        for (const auto& parameter : filter.parameters()) {
            const auto parameter_name = parameter.name().to_string();
            if (!knows(kinds[kind], parameter_name)) {
                return refuse(v1::STATUS_NOT_FOUND, name + ".parameters: " + setting.filter +
                                                        " has no parameter " + parameter_name);
            }
            setting.parameters.push_back({parameter_name, parameter.value()});
        }
        wanted.settings.push_back(std::move(setting));
    }
    return wanted;
}

Result<v1::FilterSetting> to_wire(const FilterSetting& setting) {
    const auto kind = find_filter_kind(setting.filter);
    if (!kind) return tl::unexpected(kind.error());
    if (setting.file.size() > longest_file || setting.parameters.size() > most_parameters) {
        return fail(setting.filter + ": a request carries a file name of at most 255 bytes and " +
                    "at most 16 parameters");
    }
    v1::FilterSetting wire;
    wire.kind(static_cast<v1::FilterKind>(*kind));
    wire.file(setting.file);
    for (const auto& [name, value] : setting.parameters) {
        if (name.size() > longest_parameter) {
            return fail(setting.filter + ": parameter " + name.substr(0, 64) + " is unknown");
        }
        v1::NamedValue parameter;
        parameter.name(name);
        parameter.value(value);
        wire.parameters().push_back(parameter);
    }
    return wire;
}

}  // namespace pursuit::sensor
