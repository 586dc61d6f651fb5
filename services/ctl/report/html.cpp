// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/report/html.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace pursuit::ctl {
namespace {

std::string print(const char* format, int digits, double value) {
    std::array<char, 400> text{};
    std::snprintf(text.data(), text.size(), format, digits, value);
    return text.data();
}

/// How many bytes the UTF-8 character at the front of `text` has; 0 where it is none.
std::size_t utf8_length(std::string_view text) {
    const auto first = static_cast<unsigned char>(text[0]);
    const std::size_t length = first < 0x80                     ? 1
                               : first >= 0xC2 && first <= 0xDF ? 2
                               : (first & 0xF0) == 0xE0         ? 3
                               : first >= 0xF0 && first <= 0xF4 ? 4
                                                                : 0;
    if (length == 0 || length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return 0;
    }
    return length;
}

}  // namespace

std::string escape_html(std::string_view text, std::size_t max_bytes) {
    const bool cut = text.size() > max_bytes;
    text = text.substr(0, max_bytes);
    std::string out;
    while (!text.empty()) {
        const char c = text[0];
        const std::size_t length = utf8_length(text);
        if (c == '&') {
            out += "&amp;";
        } else if (c == '<') {
            out += "&lt;";
        } else if (c == '>') {
            out += "&gt;";
        } else if (c == '"') {
            out += "&quot;";
        } else if (c == '\'') {
            out += "&#39;";
        } else if (length == 0 || (static_cast<unsigned char>(c) < 0x20 && c != '\n')) {
            out += "\xEF\xBF\xBD";  // The replacement character.
        } else {
            out += text.substr(0, length);
        }
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    if (cut) out += "…";
    return out;
}

std::string number(double value, int digits) {
    if (!std::isfinite(value)) return "–";
    return print("%.*f", digits, value);
}

std::string short_number(double value) {
    if (!std::isfinite(value)) return "–";
    const double size = std::abs(value);
    if (size >= 1e12) return print("%.*g", 3, value);
    if (size >= 1e9) return print("%.*g G", 3, value / 1e9);
    if (size >= 1e6) return print("%.*g M", 3, value / 1e6);
    if (size >= 1e4) return print("%.*g k", 3, value / 1e3);
    return print("%.*g", 4, value);
}

std::string coordinate(double value) {
    auto text = print("%.*f", 2, std::clamp(value, -1e7, 1e7));
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

std::string base64(std::span<const std::uint8_t> data) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((data.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < data.size(); i += 3) {
        const std::size_t n = std::min<std::size_t>(3, data.size() - i);
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            bits = bits << 8 | (k < n ? data[i + k] : std::uint32_t{0});
        }
        for (std::size_t k = 0; k < 4; ++k) {
            out += k <= n ? digits[bits >> (18 - 6 * k) & 63] : '=';
        }
    }
    return out;
}

}  // namespace pursuit::ctl
