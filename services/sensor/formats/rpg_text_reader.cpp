// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/rpg_text_reader.hpp"

#include <optional>
#include <string>
#include <utility>

#include "services/sensor/formats/records.hpp"
#include "services/sensor/formats/text_line.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t rpg_longest_line = 256;
constexpr Geometry davis240{240, 180};

bool is_rpg_digit(char c) { return c >= '0' && c <= '9'; }

/// "2.097134501" → 2097135. Digit by digit: as a double, a time since 1970 would lose its us.
std::optional<std::int64_t> microseconds(std::string_view word) {
    std::int64_t t_us = 0;
    int decimals = -1;  // digits after the point so far; -1: before it
    bool any = false;
    for (const char c : word) {
        if (c == '.' && decimals < 0) {
            decimals = 0;
        } else if (!is_rpg_digit(c)) {
            return std::nullopt;
        } else if (decimals < 6) {
            if (t_us > std::int64_t{100'000'000'000'000'000}) return std::nullopt;
            t_us = t_us * 10 + (c - '0');
            if (decimals >= 0) ++decimals;
            any = true;
        } else {
            if (decimals == 6 && c >= '5') ++t_us;
            decimals = 7;
        }
    }
    if (!any) return std::nullopt;
    for (int i = std::max(decimals, 0); i < 6; ++i) {
        if (t_us > std::int64_t{100'000'000'000'000'000}) return std::nullopt;
        t_us *= 10;
    }
    return t_us;
}

class RpgTextReader final : public EventReader {
 public:
    RpgTextReader(ByteWindow bytes, Geometry geometry)
        : bytes_(std::move(bytes)), geometry_(geometry) {}

    Geometry geometry() const override { return geometry_; }

 protected:
    Decoded decode(std::span<Event> events, std::span<Event> /*exposures*/) override {
        Decoded done;
        while (done.count < events.size() && !done.error) {
            const auto line = bytes_.line(rpg_longest_line);
            if (!line) {
                done.error = line.error();
                break;
            }
            if (line->empty()) break;
            ++line_;
            if (line->size() == rpg_longest_line && line->back() != '\n') {
                done.error = error("the line is longer than 256 bytes");
            } else if (auto cause = read_line(*line, events[done.count])) {
                done.error = error(*cause);
            } else {
                done.count += holds_event_ ? 1 : 0;
                bytes_.consume(line->size());
            }
            // What has arrived is not held back until the next line has.
            if (done.count > 0 && bytes_.at_hand().size() < rpg_longest_line) break;
        }
        return done;
    }

 private:
    Error error(const std::string& cause) const {
        return error_at(bytes_.name(), bytes_.offset(),
                        "line " + std::to_string(line_) + ": " + cause);
    }

    std::optional<std::string> read_line(std::string_view line, Event& event) {
        const auto time = take_word(line);
        holds_event_ = !time.empty() && time.front() != '#';
        if (!holds_event_) return std::nullopt;
        const auto t_us = microseconds(time);
        if (!t_us) return "\"" + std::string(time) + "\" is not a time in seconds";
        event.t_us = *t_us;
        unsigned polarity = 0;
        if (!parse(take_word(line), event.x) || !parse(take_word(line), event.y) ||
            !parse(take_word(line), polarity) || !take_word(line).empty()) {
            return "must be \"t_s x y p\"";
        }
        if (polarity > 1) return "polarity " + std::to_string(polarity) + " is not 0 or 1";
        event.polarity = static_cast<std::uint8_t>(polarity);
        if (event.x >= geometry_.width || event.y >= geometry_.height) {
            return outside(event.x, event.y, geometry_);
        }
        if (event.t_us < last_t_us_) {
            return time_goes_back(last_t_us_, event.t_us);
        }
        if (event.t_us >= max_t_us) return time_too_late(event.t_us);
        last_t_us_ = event.t_us;
        return std::nullopt;
    }

    ByteWindow bytes_;
    Geometry geometry_;
    std::uint64_t line_ = 0;
    std::int64_t last_t_us_ = 0;
    bool holds_event_ = false;
};

}  // namespace

bool looks_like_rpg_text(std::string_view head) {
    const auto begin = head.find_first_not_of(" \t\r\n");
    return begin != std::string_view::npos && (is_rpg_digit(head[begin]) || head[begin] == '#') &&
           head.find('\0') == std::string_view::npos && head.find(',') == std::string_view::npos &&
           head.substr(0, 2) != "#!";
}

Result<std::unique_ptr<EventReader>> open_rpg_text(ByteWindow bytes, const ReadOptions& options) {
    return std::make_unique<RpgTextReader>(std::move(bytes), options.geometry.value_or(davis240));
}

}  // namespace pursuit::sensor
