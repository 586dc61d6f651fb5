// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/commands/option_values.hpp"

#include <cmath>

#include "services/common/geometry_text.hpp"
#include "services/sensor/formats/formats.hpp"

namespace pursuit::ctl {

std::string format_help() {
    std::string names;
    for (const auto& format : sensor::formats()) {
        names += (names.empty() ? "" : ", ") + std::string(format.name);
    }
    return "Format, where the file does not tell: " + names;
}

CLI::Validator finite_range(double least, double most) {
    const CLI::Range range(least, most);
    CLI::Validator validator = range;
    validator.operation([range](std::string& text) {
        double value = 0;
        const bool is_nan = CLI::detail::lexical_cast(text, value) && std::isnan(value);
        return is_nan ? "Value " + text + " is not a number" : range(text);
    });
    return validator;
}

Result<std::optional<Geometry>> geometry_of(const std::string& text) {
    if (text.empty()) return std::optional<Geometry>{};
    const auto geometry = parse_geometry(text);
    if (!geometry) return fail("--geometry: \"" + text + "\" is not WxH, as in 640x480");
    return geometry;
}

}  // namespace pursuit::ctl
