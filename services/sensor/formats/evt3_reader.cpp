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
            if (can_run()) at = take_run(at, end, events, done.count);
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

    /// Whether take_run() may go on from here: an event would be good wherever its column is.
    bool can_run() const {
        return is_ready() && taken_of_vector_ == 0 && y_ < settings_.geometry.height &&
               high_us_ + low_us_ >= last_t_us_;
    }

    /// Takes words while can_run() stays true, up to the first of a rare kind or a bad event, and
    /// returns where that is. Whether a word is a row or an event cannot be foreseen: masks instead
    /// of branches. Not inlined, so that the loop has all registers.
    [[gnu::noinline]] const std::uint8_t* take_run(const std::uint8_t* at, const std::uint8_t* end,
                                                   std::span<Event> events, std::size_t& count) {
        auto* const first = events.data() + count;
        auto* const events_end = events.data() + events.size();
        auto* event = first;
        const std::uint32_t width = settings_.geometry.width;
        const std::uint32_t height = settings_.geometry.height;
        const auto high_us = high_us_;
        const auto same_high = time_high << 12 | static_cast<std::uint32_t>(high_.stored());
        auto t_us = high_us + low_us_;
        auto y = y_;
        auto base_x = base_x_;
        auto base_polarity = base_polarity_;
        for (; at != end && event != events_end; at += word_bytes) {
            const std::uint32_t word = load<std::uint16_t>(at);
            const auto kind = word >> 12;
            const auto number = word & 0x7ff;
            if (kind == addr_x || kind == addr_y) {
                const std::uint32_t is_event = kind >> 1;
                if (number >= chosen(is_event, width, height)) break;
                y = chosen(is_event, y, number);
                store(*event, t_us, number, y, word >> 11 & 1);
                event += is_event;
            } else if (kind == time_low) {
                if (high_us + (word & 0xfff) < t_us) break;
                t_us = high_us + (word & 0xfff);
            } else if (kind == vect_base_x) {
                base_x = number;
                base_polarity = word >> 11 & 1;
            } else if (kind == vect_12 || kind == vect_8) {
                const auto valid = valid_of(word);
                const auto end_x = base_x + static_cast<std::uint32_t>(std::bit_width(valid));
                if (events_end - event < 12 || (end_x > width && valid != 0)) break;
                event = store_vector(event, t_us, base_x, y, base_polarity, valid);
                base_x = moved_on(base_x, kind);
            } else if (word != same_high) {
                break;
            }
        }
        if (event != first) last_t_us_ = event[-1].t_us;
        low_us_ = t_us - high_us;
        y_ = y;
        base_x_ = base_x;
        base_polarity_ = base_polarity;
        count = static_cast<std::size_t>(event - events.data());
        return at;
    }

    /// condition ? a : b, of a condition 0 or 1, by a mask.
    static std::uint32_t chosen(std::uint32_t condition, std::uint32_t a, std::uint32_t b) {
        return b ^ ((a ^ b) & (0U - condition));
    }

    /// Stores events at the set bits of `valid`; 12 must fit. There are seldom more than two, so
    /// two are stored anyway and those that are none are overwritten.
    static Event* store_vector(Event* event, std::int64_t t_us, std::uint32_t first_x,
                               std::uint32_t y, std::uint32_t polarity, std::uint32_t valid) {
        const auto next_x = [&] {
            return first_x + static_cast<std::uint32_t>(std::countr_zero(valid));
        };
        for (int i = 0; i < 2; ++i, valid &= valid - 1) {
            store(*event, t_us, next_x() & 0xffff, y, polarity);
            event += valid != 0;
        }
        for (; valid != 0; valid &= valid - 1) store(*event++, t_us, next_x(), y, polarity);
        return event;
    }

    static std::uint32_t moved_on(std::uint32_t base_x, std::uint32_t kind) {
        return base_x >= no_base ? base_x : base_x + (kind == vect_12 ? 12 : 8);
    }

    /// Takes any word; returns what is wrong with it.
    [[gnu::noinline]] std::optional<std::string> take(std::uint32_t word, std::span<Event> events,
                                                      Decoded& done) {
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
        if (taken_of_vector_ == 0) base_x_ = moved_on(base_x_, word >> 12);
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
