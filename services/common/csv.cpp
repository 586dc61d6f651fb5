// SPDX-License-Identifier: Apache-2.0
#include "services/common/csv.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace pursuit {
namespace {

constexpr std::size_t longest_line = 1 << 16;

std::string_view trimmed(std::string_view text) {
    const auto begin = std::min(text.find_first_not_of(" \t\r"), text.size());
    text.remove_prefix(begin);
    return text.substr(0, text.find_last_not_of(" \t\r") + 1);
}

template <class Number>
void append_shortest(std::string& text, Number value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text.append(digits.data(), end);
}

}  // namespace

CsvReader::CsvReader(std::string path)
    : path_(std::move(path)), in_(path_, std::ios::binary), line_(longest_line) {}

Result<CsvReader> CsvReader::open(const std::string& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) return fail(path + ": is a folder");
    CsvReader reader(path);
    if (!reader.in_) return fail(path + ": cannot open: " + std::strerror(errno));
    const auto header = reader.next();
    if (!header) return tl::unexpected(header.error());
    if (!*header) return fail(path + ": has no line of column names");
    reader.columns_.assign(reader.fields_.begin(), reader.fields_.end());
    return reader;
}

std::optional<std::size_t> CsvReader::column(std::string_view name) const {
    const auto found = std::find(columns_.begin(), columns_.end(), name);
    if (found == columns_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - columns_.begin());
}

Result<std::size_t> CsvReader::required_column(std::string_view name) const {
    if (const auto found = column(name)) return *found;
    return fail(path_ + ": has no column " + std::string(name));
}

Result<bool> CsvReader::next_line() {
    if (in_.eof()) return false;
    in_.getline(line_.data(), static_cast<std::streamsize>(line_.size()));
    ++line_number_;
    if (in_.bad()) return fail(path_ + ": cannot read: " + std::strerror(errno));
    if (!in_.fail()) return true;
    if (in_.gcount() == static_cast<std::streamsize>(line_.size()) - 1) {
        return fail(where() + ": the line is longer than 64 KiB");
    }
    return false;  // nothing after the last line's end
}

Result<bool> CsvReader::next() {
    for (;;) {
        const auto more = next_line();
        if (!more || !*more) return more;
        auto rest = trimmed(line_.data());
        if (rest.empty() || rest.front() == '#') continue;
        fields_.clear();
        for (;;) {
            const auto comma = rest.find(',');
            fields_.push_back(trimmed(rest.substr(0, comma)));
            if (comma == std::string_view::npos) return true;
            rest.remove_prefix(comma + 1);
        }
    }
}

Result<void> CsvReader::check_length() const {
    if (fields_.size() >= columns_.size()) return {};
    return fail(where() + ": the row ends before column " + columns_[fields_.size()]);
}

std::string CsvReader::not_a_number(std::size_t column) const {
    return where() + ": column " +
           (column < columns_.size() ? columns_[column] : std::to_string(column)) + ": \"" +
           std::string(field(column)) + "\" is not a number of its kind";
}

void append_number(std::string& text, double value) { append_shortest(text, value); }

void append_number(std::string& text, float value) { append_shortest(text, value); }

}  // namespace pursuit
