// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/common/result.hpp"

namespace pursuit {

/// Reads a table of comma-separated values: a line of column names, then rows. Blanks around a
/// value, empty lines and lines that begin with '#' are passed over; there are no quotes. A line
/// has at most 64 KiB. Errors name file and line.
class CsvReader {
 public:
    static Result<CsvReader> open(const std::string& path);

    /// Where the column of that name is; nothing where there is none.
    std::optional<std::size_t> column(std::string_view name) const;

    /// As column(), an error where there is none.
    Result<std::size_t> required_column(std::string_view name) const;

    /// Moves on to the next row: true; false at the end.
    Result<bool> next();

    /// An error that names the column before which this row ends, where it is shorter than the line
    /// of names: a table that was cut off.
    Result<void> check_length() const;

    /// The value in a column of this row; empty where the row is shorter.
    std::string_view field(std::size_t column) const {
        return column < fields_.size() ? fields_[column] : std::string_view{};
    }

    /// The number in a column of this row; "nan" and "inf" are numbers.
    template <class Number>
    Result<Number> number(std::size_t column) const {
        const auto text = field(column);
        Number value{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (text.empty() || error != std::errc() || end != text.data() + text.size()) {
            return fail(not_a_number(column));
        }
        return value;
    }

    const std::string& path() const { return path_; }

    /// "file:line", of this row.
    std::string where() const { return path_ + ":" + std::to_string(line_number_); }

 private:
    explicit CsvReader(std::string path);
    Result<bool> next_line();
    std::string not_a_number(std::size_t column) const;

    std::string path_;
    std::ifstream in_;
    std::vector<char> line_;
    std::uint64_t line_number_ = 0;
    std::vector<std::string> columns_;
    std::vector<std::string_view> fields_;
};

/// Appends the shortest text that reads back as the same bits.
void append_number(std::string& text, double value);
void append_number(std::string& text, float value);

}  // namespace pursuit
