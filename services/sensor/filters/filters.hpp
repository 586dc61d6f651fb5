// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "services/sensor/filters/filter.hpp"
#include "services/sensor/filters/filter_setting.hpp"

namespace pursuit::sensor {

/// A kind of filter: one file of code, and one line in the table of filters.cpp.
struct FilterKind {
    std::string_view name;
    std::string_view what;  ///< One line for people.
    std::span<const FilterParameter> parameters;
    bool takes_file;  ///< And then needs one.

    /// For events of `input`; an error names what does not fit it, or the fault of the file.
    Result<std::unique_ptr<Filter>> (*make)(const FilterArguments& arguments, Geometry input);
};

/// In the order of FilterKind in idl/sensor_requests.idl.
std::span<const FilterKind> filter_kinds();

/// Where the kind of that name is in the table; an error names those there are.
Result<std::size_t> find_filter_kind(std::string_view name);

/// What can be said of a setting before there are events: name, parameters, ranges, and whether a
/// file is named where one is needed.
Result<void> check_filter(const FilterSetting& setting);

/// As check_filter(), then makes it; `input` has at least one pixel and at most 32768 rows.
Result<std::unique_ptr<Filter>> make_filter(const FilterSetting& setting, Geometry input);

}  // namespace pursuit::sensor
