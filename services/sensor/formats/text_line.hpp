// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>

namespace pursuit::sensor {

/// The next word of `line`, which loses it with the separators before it.
inline std::string_view take_word(std::string_view& line, std::string_view separators = " \t\r\n") {
    const auto begin = std::min(line.find_first_not_of(separators), line.size());
    const auto end = std::min(line.find_first_of(separators, begin), line.size());
    const auto word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

/// What of `text` stands before `separator`; `text` loses both.
inline std::string_view take_until(std::string_view& text, char separator) {
    const auto end = std::min(text.find(separator), text.size());
    const auto part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return part;
}

/// A whole word as a decimal number.
template <class Number>
bool parse(std::string_view word, Number& number) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return error == std::errc() && end == word.data() + word.size();
}

/// Binary data may begin with the sign that begins a header's lines; a line is text up to its end.
inline bool is_text_line(std::string_view line) {
    return !line.empty() && line.back() == '\n' &&
           std::all_of(line.begin(), line.end() - 1, [](unsigned char c) {
               return (c >= ' ' && c != 0x7f) || c == '\t' || c == '\r';
           });
}

/// What is wrong with a header's line that is no text; empty where it is data that begins like a
/// line. Words and addresses are not 32 characters of ASCII by chance.
inline std::string header_line_fault(std::string_view line, std::size_t longest) {
    constexpr std::size_t no_chance = 32;
    const auto is_ascii = [](unsigned char c) { return (c >= ' ' && c < 0x7f) || c == '\t'; };
    const auto begin = line.substr(0, no_chance);
    if (begin.size() < no_chance || !std::all_of(begin.begin(), begin.end(), is_ascii)) return {};
    const bool ends = line.back() == '\n';
    const bool is_text = is_text_line(std::string(line) + (ends ? "" : "\n"));
    if (!is_text) return "a control character in a header line";
    return line.size() >= longest
               ? "a header line longer than " + std::to_string(longest) + " bytes"
               : "a header line does not end";
}

/// A line without its end and the blanks before it.
inline std::string_view trimmed(std::string_view line) {
    return line.substr(0, line.find_last_not_of(" \t\r\n") + 1);
}

}  // namespace pursuit::sensor
