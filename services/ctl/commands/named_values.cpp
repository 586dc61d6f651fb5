// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/commands/named_values.hpp"

#include <charconv>
#include <system_error>

#include "services/ctl/json_text.hpp"

namespace pursuit::ctl {
namespace {

constexpr std::size_t max_name_length = 47;
constexpr std::size_t max_values = 32;

}  // namespace

Result<std::vector<v1::NamedValue>> named_values(const std::vector<std::string>& settings) {
    if (settings.size() > max_values) {
        return fail(std::to_string(settings.size()) + " settings, at most " +
                    std::to_string(max_values) + " go into a request");
    }
    std::vector<v1::NamedValue> values;
    for (const auto& setting : settings) {
        const auto equals = setting.find('=');
        if (equals == std::string::npos || equals == 0 || equals > max_name_length) {
            return fail("\"" + setting + "\" is not name=value with a name of 1 to " +
                        std::to_string(max_name_length) + " characters");
        }
        double value = 0;
        const char* begin = setting.data() + equals + 1;
        const char* end = setting.data() + setting.size();
        const auto [rest, error] = std::from_chars(begin, end, value);
        if (error != std::errc() || rest != end) {
            return fail("\"" + setting + "\": \"" + std::string(begin, end) + "\" is not a number");
        }
        v1::NamedValue named;
        named.name(setting.substr(0, equals));
        named.value(value);
        values.push_back(named);
    }
    return values;
}

std::string listed(const std::vector<v1::NamedValue>& values) {
    std::string text;
    for (const auto& value : values) {
        text += "  " + value.name().to_string() + " = " + number_text(value.value()) + "\n";
    }
    return text;
}

}  // namespace pursuit::ctl
