// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/evt3_reader.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <string>
#include <utility>

namespace pursuit::sensor {
namespace {

constexpr std::size_t word_bytes = 2;
constexpr std::uint32_t no_base = 1 << 13;  // outside of any array, as is what it moves on to

enum Kind : std::uint32_t {
    addr_y = 0,
    addr_x = 2,
    vect_base_x = 3,
    vect_12 = 4,
    vect_8 = 5,
    time_low = 6,
    more_4 = 7,
    time_high = 8,
    trigger = 10,
    others = 14,
    more_12 = 15
};

/// Three in four words are of one of these.
constexpr bool is_frequent(std::uint32_t kind) {
    return ((1U << addr_y | 1U << addr_x | 1U << time_low) >> kind & 1) != 0;
}

/// Which pixels from the base on a vector has events at.
constexpr std::uint32_t valid_of(std::uint32_t word) {
    return word >> 12 == vect_12 ? word & 0xfff : word & 0xff;
}

class Evt3Reader final : public EventReader {
 public:
    Evt3Reader(ByteWindow bytes, const RawSettings& settings)
        : bytes_(std::move(bytes)), settings_(settings) {}

    Geometry geometry() const override { return settings_.geometry; }

 protected:
    Decoded decode(std::span<Event> events, std::span<Event> /*exposures*/) override {
        Decoded done;
        const auto words = records_ahead(bytes_, word_bytes, "a word");
        if (!words) {
            done.error = words.error();
            return done;
        }
        if (words->empty()) return done;
        const auto* at = words->data();
        const auto* const end = at + words->size();
        while (at != end && done.count < events.size()) {
            if (is_ready()) at = take_frequent(at, end, events, done.count);
            if (at == end || done.count == events.size()) break;
            const std::uint32_t word = load<std::uint16_t>(at);
            if (auto cause = take(word, events, done)) {
                done.error =
                    error_at(bytes_.name(), bytes_.offset() + (at - words->data()), *cause);
                break;
            }
            // A vector whose events did not all fit is ahead again.
            if (taken_of_vector_ != 0) break;
            at += word_bytes;
        }
        bytes_.consume(static_cast<std::size_t>(at - words->data()));
        done.time_us = last_t_us_;
        done.goes_on = true;
        return done;
    }

 private:
    /// Whether an event would have a time and a row.
    bool is_ready() const {
        return high_is_known_ && row_is_known_ && (low_is_known_ || !settings_.joined_late);
    }

    /// Takes single events, rows and times up to the first word of another kind, or a bad event,
    /// and returns where that is. Which of the three a word is cannot be foreseen: no branch.
    const std::uint8_t* take_frequent(const std::uint8_t* at, const std::uint8_t* end,
                                      std::span<Event> events, std::size_t& count) {
        auto* event = events.data() + count;
        const auto* const events_end = events.data() + events.size();
        const std::uint32_t width = settings_.geometry.width;
        const std::uint32_t height = settings_.geometry.height;
        const auto high_us = high_us_;
        auto low_us = low_us_;
        auto y = y_;
        auto last_t_us = last_t_us_;
        for (; at != end && event != events_end; at += word_bytes) {
            const std::uint32_t word = load<std::uint16_t>(at);
            const auto kind = word >> 12;
            if (!is_frequent(kind)) break;
            const bool is_event = kind == addr_x;
            const auto x = word & 0x7ff;
            y = kind == addr_y ? x : y;
            low_us = kind == time_low ? word & 0xfff : low_us;
            const auto t_us = high_us + low_us;
            if (is_event && (x >= width || y >= height || t_us < last_t_us)) break;
            store(*event, t_us, x, y, word >> 11 & 1);
            event += is_event;
            last_t_us = is_event ? t_us : last_t_us;
        }
        low_us_ = low_us;
        y_ = y;
        last_t_us_ = last_t_us;
        count = static_cast<std::size_t>(event - events.data());
        return at;
    }

    /// Takes any word; returns what is wrong with it.
    std::optional<std::string> take(std::uint32_t word, std::span<Event> events, Decoded& done) {
        switch (word >> 12) {
            case addr_y:
                y_ = word & 0x7ff;
                row_is_known_ = true;
                return std::nullopt;
            case addr_x:
                return take_events(word & 0x7ff, word >> 11 & 1, 1, events, done);
            case vect_base_x:
                base_x_ = word & 0x7ff;
                base_polarity_ = word >> 11 & 1;
                return std::nullopt;
            case vect_12:
            case vect_8:
                return take_vector(word, events, done);
            case time_low:
                low_us_ = word & 0xfff;
                low_is_known_ = high_is_known_;
                return std::nullopt;
            case time_high:
                take_time_high(word & 0xfff);
                return std::nullopt;
            case trigger:
            case others:
            case more_4:
            case more_12:
                return std::nullopt;
            default:
                return "a word of kind " + std::to_string(word >> 12) +
                       ", which EVT3 does not define";
        }
    }

    void take_time_high(std::uint32_t high) {
        high_.set(high);
        if (high_us_ != high_.value() * 4096) low_us_ = 0;
        high_us_ = high_.value() * 4096;
        high_is_known_ = true;
        last_t_us_ = std::max(last_t_us_, high_us_);
    }

    std::optional<std::string> take_vector(std::uint32_t word, std::span<Event> events,
                                           Decoded& done) {
        const auto valid = valid_of(word);
        if (auto cause = take_events(base_x_, base_polarity_, valid, events, done)) return cause;
        if (taken_of_vector_ == 0 && base_x_ < no_base) base_x_ += word >> 12 == vect_12 ? 12 : 8;
        return std::nullopt;
    }

    /// Makes events at those of the pixels from first_x on whose bit is set in `valid`.
    std::optional<std::string> take_events(std::uint32_t first_x, std::uint32_t polarity,
                                           std::uint32_t valid, std::span<Event> events,
                                           Decoded& done) {
        if (valid == 0) return std::nullopt;
        if (!is_ready() || first_x >= no_base) {
            if (!settings_.joined_late) return describe_unready();
            done.skipped += static_cast<std::uint64_t>(std::popcount(valid));
            return std::nullopt;
        }
        const auto t_us = high_us_ + low_us_;
        if (t_us < last_t_us_) return time_goes_back(last_t_us_, t_us);
        for (auto rest = valid & ~taken_of_vector_; rest != 0; rest &= rest - 1) {
            const auto x = first_x + static_cast<std::uint32_t>(std::countr_zero(rest));
            if (x >= settings_.geometry.width || y_ >= settings_.geometry.height) {
                return outside(x, y_, settings_);
            }
            if (done.count == events.size()) {
                taken_of_vector_ = valid & ~rest;
                return std::nullopt;
            }
            store(events[done.count++], t_us, x, y_, polarity);
            last_t_us_ = t_us;
        }
        taken_of_vector_ = 0;
        return std::nullopt;
    }

    std::string describe_unready() const {
        if (!high_is_known_) return "an event before the first TIME_HIGH has no time";
        if (!row_is_known_) return "an event before the first ADDR_Y has no row";
        return "a vector before the first VECT_BASE_X has no column";
    }

    ByteWindow bytes_;
    RawSettings settings_;
    Unwrapped<12> high_;
    std::int64_t high_us_ = 0;
    std::int64_t low_us_ = 0;
    std::int64_t last_t_us_ = 0;  // of an event or of TIME_HIGH
    std::uint32_t y_ = 0;
    std::uint32_t base_x_ = no_base;
    std::uint32_t base_polarity_ = 0;
    std::uint32_t taken_of_vector_ =
        0;  // the events of the vector ahead that are delivered already
    bool high_is_known_ = false;
    bool low_is_known_ = false;
    bool row_is_known_ = false;
};

}  // namespace

std::unique_ptr<EventReader> make_evt3_reader(ByteWindow bytes, const RawSettings& settings) {
    return std::make_unique<Evt3Reader>(std::move(bytes), settings);
}

}  // namespace pursuit::sensor
