// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <concepts>
#include <string>
#include <string_view>

namespace pursuit::ctl {

/// The shortest text that reads back as the same number.
template <class Number>
std::string number_text(Number value) {
    char text[40];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return {text, end};
}

/// A JSON string with its quotes (RFC 8259, section 7). Bytes that are not ASCII pass unchanged.
inline std::string json_string(std::string_view text) {
    constexpr char digits[] = "0123456789abcdef";
    std::string quoted = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte == '"' || byte == '\\') {
            quoted += '\\';
            quoted += c;
        } else if (byte < 0x20) {
            quoted += "\\u00";
            quoted += digits[byte >> 4];
            quoted += digits[byte & 15];
        } else {
            quoted += c;
        }
    }
    return quoted + "\"";
}

/// A JSON object, member by member. Numbers that are not finite, which JSON does not have, become
/// null.
class JsonObject {
 public:
    JsonObject& raw(std::string_view name, std::string_view json) {
        text_ += text_.empty() ? "{" : ", ";
        text_ += json_string(name);
        text_ += ": ";
        text_ += json;
        return *this;
    }
    JsonObject& add(std::string_view name, std::string_view text) {
        return raw(name, json_string(text));
    }
    JsonObject& add(std::string_view name, const char* text) {
        return raw(name, json_string(text));
    }
    JsonObject& add(std::string_view name, bool value) {
        return raw(name, value ? "true" : "false");
    }
    template <std::integral Number>
    JsonObject& add(std::string_view name, Number value) {
        return raw(name, number_text(value));
    }
    template <std::floating_point Number>
    JsonObject& add(std::string_view name, Number value) {
        return raw(name, std::isfinite(value) ? number_text(value) : "null");
    }

    [[nodiscard]] std::string text() const { return text_.empty() ? "{}" : text_ + "}"; }

 private:
    std::string text_;
};

}  // namespace pursuit::ctl
