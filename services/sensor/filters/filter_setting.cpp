// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/filter_setting.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

namespace pursuit::sensor {
namespace {

constexpr std::string_view blanks = " \t\n\r";
constexpr std::string_view file_key = "file=";

/// Takes the next word off `text`; empty at its end.
std::string_view next_word(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    const auto word = text.substr(0, text.find_first_of(blanks));
    text.remove_prefix(word.size());
    return word;
}

}  // namespace

std::string shown(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.15g", value);
    return text;
}

Result<FilterSetting> parse_filter(std::string_view text) {
    FilterSetting setting;
    setting.filter = next_word(text);
    if (setting.filter.empty()) return fail("a filter without a name");
    for (;;) {
        text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
        if (text.starts_with(file_key)) {
            text.remove_prefix(file_key.size());
            setting.file = text.substr(0, text.find_last_not_of(blanks) + 1);
            if (setting.file.empty()) return fail(setting.filter + ": file= names no file");
            return setting;
        }
        const auto word = next_word(text);
        if (word.empty()) return setting;
        const auto equals = word.find('=');
        double value = 0;
        const auto number = equals == word.npos ? std::string_view{} : word.substr(equals + 1);
        const auto [end, error] =
            std::from_chars(number.data(), number.data() + number.size(), value);
        if (equals == 0 || number.empty() || error != std::errc() ||
            end != number.data() + number.size()) {
            return fail(setting.filter + ": \"" + std::string(word) + "\" is not name=number");
        }
        setting.parameters.push_back({std::string(word.substr(0, equals)), value});
    }
}

std::string to_text(const FilterSetting& setting) {
    std::string text = setting.filter;
    for (const auto& [name, value] : setting.parameters) text += " " + name + "=" + shown(value);
    if (!setting.file.empty()) text += " " + std::string(file_key) + setting.file;
    return text;
}

FilterArguments::FilterArguments(std::span<const FilterParameter> parameters, std::string file)
    : parameters_(parameters), file_(std::move(file)) {
    for (const auto& parameter : parameters) values_.push_back(parameter.standard);
}

Result<FilterArguments> FilterArguments::of(const FilterSetting& setting,
                                            std::span<const FilterParameter> parameters) {
    FilterArguments arguments(parameters, setting.file);
    std::vector<bool> given(parameters.size());
    for (const auto& parameter : setting.parameters) {
        const auto& name = parameter.name;
        const double value = parameter.value;
        const auto found = std::find_if(parameters.begin(), parameters.end(),
                                        [&](const auto& known) { return known.name == name; });
        if (found == parameters.end()) return fail("parameter " + name + " is unknown");
        const auto index = static_cast<std::size_t>(found - parameters.begin());
        const bool whole = !found->whole || std::trunc(value) == value;
        if (!(value >= found->min && value <= found->max) || !whole) {
            return fail("parameter " + name + " is " + shown(value) + ", must be " +
                        (found->whole ? "a whole number from " : "") + shown(found->min) + " to " +
                        shown(found->max) +
                        (found->unit.empty() ? "" : " " + std::string(found->unit)));
        }
        if (given[index]) return fail("parameter " + name + " is given twice");
        given[index] = true;
        arguments.values_[index] = value;
    }
    return arguments;
}

double FilterArguments::operator[](std::string_view name) const {
    const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                    [&](const auto& known) { return known.name == name; });
    return values_.at(static_cast<std::size_t>(found - parameters_.begin()));
}

}  // namespace pursuit::sensor
