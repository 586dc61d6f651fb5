// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/csv_reader.hpp"

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "services/sensor/formats/records.hpp"
#include "services/sensor/formats/text_line.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t csv_longest_line = 1024;
constexpr std::size_t most_columns = 16;

bool is_csv_digit(char c) { return c >= '0' && c <= '9'; }
bool is_remark(std::string_view line) { return line[0] == '#' || line[0] == '%'; }

/// Which column holds what.
struct Columns {
    std::size_t t = 0, x = 1, y = 2, p = 3;
    std::size_t count = 4;
};

std::string_view without_blanks(std::string_view field) { return take_word(field); }

/// The columns of a line of names; none where one is missing, stands twice or there are too many.
std::optional<Columns> columns_named(std::string_view line) {
    constexpr auto missing = most_columns;
    Columns columns{missing, missing, missing, missing, 0};
    while (!line.empty()) {
        const auto name = without_blanks(take_until(line, ','));
        std::size_t* column =
            name == "t" || name == "t_us" || name == "timestamp" || name == "timestamp_us"
                ? &columns.t
            : name == "x"                       ? &columns.x
            : name == "y"                       ? &columns.y
            : name == "p" || name == "polarity" ? &columns.p
                                                : nullptr;
        if (columns.count == most_columns || (column != nullptr && *column != missing)) return {};
        if (column != nullptr) *column = columns.count;
        ++columns.count;
    }
    if (columns.t == missing || columns.x == missing || columns.y == missing ||
        columns.p == missing) {
        return {};
    }
    return columns;
}

class CsvReader final : public EventReader {
 public:
    explicit CsvReader(ByteWindow bytes) : bytes_(std::move(bytes)) {}

    /// Reads what stands before the events.
    Result<void> read_header(std::optional<Geometry> geometry) {
        bool has_names = false;
        for (;;) {
            const auto line = next_line();
            if (!line) return tl::unexpected(line.error());
            if (line->empty()) break;
            const auto text = trimmed(*line);
            if (text.empty() || is_remark(text)) {
                if (auto stated = stated_geometry(text)) geometry_ = *stated;
            } else if (!has_names && !is_csv_digit(text[0]) && text[0] != '-') {
                const auto columns = columns_named(text);
                if (!columns) {
                    return tl::unexpected(error(
                        "must name the columns t_us, x, y and p (or be numbers in this order)"));
                }
                columns_ = *columns;
                has_names = true;
            } else {
                --line_;  // the first event
                break;
            }
            bytes_.consume(line->size());
        }
        if (geometry) geometry_ = *geometry;
        if (geometry_.width == 0 || geometry_.height == 0) {
            return tl::unexpected(error(
                "no line \"# geometry WxH\" before here states the pixels, and none are named"));
        }
        return {};
    }

    Geometry geometry() const override { return geometry_; }

 protected:
    Decoded decode(std::span<Event> events, std::span<Event> /*exposures*/) override {
        Decoded done;
        while (done.count < events.size() && !done.error) {
            const auto line = next_line();
            if (!line) {
                done.error = line.error();
                break;
            }
            if (line->empty()) break;
            const auto text = trimmed(*line);
            if (!text.empty() && !is_remark(text)) {
                // At the file's end a number may be cut: what is left of it reads as another.
                const bool may_go_on = line->size() == text.size() && last_goes_on();
                if (may_go_on) {
                    done.error = error("the file ends within it: no end of line follows");
                    break;
                }
                if (auto cause = read_event(text, events[done.count])) {
                    done.error = error(*cause);
                    break;
                }
                ++done.count;
            }
            bytes_.consume(line->size());
            // What has arrived is not held back until the next line has.
            if (done.count > 0 && bytes_.at_hand().size() < csv_longest_line) break;
        }
        return done;
    }

 private:
    /// The line ahead, counted, not consumed; empty at the end.
    Result<std::string_view> next_line() {
        const auto line = bytes_.line(csv_longest_line);
        if (!line || line->empty()) return line;
        ++line_;
        if (line->size() == csv_longest_line && line->back() != '\n') {
            return tl::unexpected(error("the line is longer than 1024 bytes"));
        }
        return line;
    }

    /// Whether a line ends with a number that is used and may have another digit: all but p.
    bool last_goes_on() const {
        const auto last = columns_.count - 1;
        return last == columns_.t || last == columns_.x || last == columns_.y;
    }

    Error error(const std::string& cause) const {
        return error_at(bytes_.name(), bytes_.offset(),
                        "line " + std::to_string(line_) + ": " + cause);
    }

    /// "# geometry 304x240", "%geometry:304,240"
    static std::optional<Geometry> stated_geometry(std::string_view remark) {
        if (take_word(remark, "#% \t:") != "geometry") return {};
        Geometry geometry;
        if (!parse(take_word(remark, " \t:x,"), geometry.width)) return {};
        if (!parse(take_word(remark, " \t:x,"), geometry.height)) return {};
        return geometry;
    }

    std::optional<std::string> read_event(std::string_view line, Event& event) {
        std::array<std::string_view, most_columns> fields;
        std::size_t count = 0;
        while (!line.empty() && count < columns_.count) {
            fields[count++] = without_blanks(take_until(line, ','));
        }
        std::uint32_t x = 0;
        std::uint32_t y = 0;
        std::uint32_t polarity = 0;
        if (count != columns_.count || !line.empty() || !parse(fields[columns_.t], event.t_us) ||
            !parse(fields[columns_.x], x) || !parse(fields[columns_.y], y) ||
            !parse(fields[columns_.p], polarity)) {
            return "must be " + std::to_string(columns_.count) +
                   " columns with the whole numbers t_us, x, y and p";
        }
        if (polarity > 1) return "polarity " + std::to_string(polarity) + " is not 0 or 1";
        if (x >= geometry_.width || y >= geometry_.height) return outside(x, y, geometry_);
        if (event.t_us < last_t_us_) return time_goes_back(last_t_us_, event.t_us);
        if (event.t_us >= max_t_us) return time_too_late(event.t_us);
        last_t_us_ = event.t_us;
        store(event, last_t_us_, x, y, polarity);
        return std::nullopt;
    }

    ByteWindow bytes_;
    Geometry geometry_;
    Columns columns_;
    std::uint64_t line_ = 0;
    std::int64_t last_t_us_ = 0;
};

}  // namespace

bool looks_like_csv(std::string_view head) {
    return head.find('\0') == std::string_view::npos && head.find(',') != std::string_view::npos &&
           head.substr(0, 2) != "#!" && head.substr(0, 2) != "% ";
}

Result<std::unique_ptr<EventReader>> open_csv(ByteWindow bytes, const ReadOptions& options) {
    auto reader = std::make_unique<CsvReader>(std::move(bytes));
    if (auto ok = reader->read_header(options.geometry); !ok) return tl::unexpected(ok.error());
    return reader;
}

}  // namespace pursuit::sensor
