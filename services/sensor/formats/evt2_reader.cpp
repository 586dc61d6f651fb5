// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/evt2_reader.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "services/sensor/formats/event_lanes.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t word_bytes = 4;
constexpr std::ptrdiff_t four_words = 16;

enum Kind : std::uint32_t { off = 0, on = 1, time_high = 8, trigger = 10, others = 14, more = 15 };

class Evt2Reader final : public EventReader {
 public:
    Evt2Reader(ByteWindow bytes, const RawSettings& settings)
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
            if (time_is_known_) at = decode_events(at, end, events, done.count);
            if (at == end || done.count == events.size()) break;
            if (auto cause = take_other(load<std::uint32_t>(at), done.skipped)) {
                done.error =
                    error_at(bytes_.name(), bytes_.offset() + (at - words->data()), *cause);
                break;
            }
            at += word_bytes;
        }
        bytes_.consume(static_cast<std::size_t>(at - words->data()));
        done.time_us = last_t_us_;
        done.goes_on = true;
        return done;
    }

 private:
    /// Decodes events up to the first word that is none, or a bad one, and returns where that is.
    const std::uint8_t* decode_events(const std::uint8_t* at, const std::uint8_t* end,
                                      std::span<Event> events, std::size_t& count) {
        auto* event = events.data() + count;
        const auto* const events_end = events.data() + events.size();
        // Times within TIME_HIGH: beyond its 64 us where TIME_HIGH has gone back.
        auto last = static_cast<std::uint32_t>(std::min<std::int64_t>(last_t_us_ - base_us_, 64));
        int taken = 0;
        do {
            while (end - at >= four_words && events_end - event >= 4 &&
                   take_four(at, event, last)) {
                at += four_words;
                event += 4;
            }
            // One of the next four is no good event, or there are not as many.
            for (taken = 0; taken < 4 && at != end && event != events_end; ++taken) {
                if (!take_one(at, event, last)) break;
                at += word_bytes;
                ++event;
            }
        } while (taken == 4);
        if (event != events.data() + count) last_t_us_ = base_us_ + last;
        count = static_cast<std::size_t>(event - events.data());
        return at;
    }

    /// Decodes four events, unless one is no event, bad, or earlier than the one before it.
    bool take_four(const std::uint8_t* at, Event* event, std::uint32_t& last) const {
        const auto words = load_lanes(at);
        const auto kind = shift_right(words, 28);
        const auto time = shift_right(words, 22) & lanes_of(63);
        const auto x = shift_right(words, 11) & lanes_of(0x7ff);
        const auto y = words & lanes_of(0x7ff);
        const auto before = moved_on(time, static_cast<std::int32_t>(last));
        if (any((kind > lanes_of(on)) | (x >= lanes_of(settings_.geometry.width)) |
                (y >= lanes_of(settings_.geometry.height)) | (time < before))) {
            return false;
        }
        const auto low = static_cast<std::uint32_t>(base_us_);
        const auto high = static_cast<std::uint32_t>(base_us_ >> 32);
        store_four(event, time | lanes_of(low), lanes_of(high), x, y, kind);
        last = static_cast<std::uint32_t>(time[3]);
        return true;
    }

    bool take_one(const std::uint8_t* at, Event* event, std::uint32_t& last) const {
        const auto word = load<std::uint32_t>(at);
        const auto time = word >> 22 & 63;
        const auto x = word >> 11 & 0x7ff;
        const auto y = word & 0x7ff;
        if (word >> 28 > on || x >= settings_.geometry.width || y >= settings_.geometry.height ||
            time < last) {
            return false;
        }
        store(*event, base_us_ + time, x, y, word >> 28);
        last = time;
        return true;
    }

    /// Takes a word that decode_events() left: of another kind, or an event that is bad, skipped
    /// or without time. Returns what is wrong with it.
    std::optional<std::string> take_other(std::uint32_t word, std::uint64_t& skipped) {
        switch (word >> 28) {
            case off:
            case on:
                if (!time_is_known_ && settings_.joined_late) {
                    ++skipped;
                    return std::nullopt;
                }
                return describe(word);
            case time_high:
                high_.set(word & 0xfff'ffff);
                base_us_ = high_.value() * 64;
                last_t_us_ = std::max(last_t_us_, base_us_);
                time_is_known_ = true;
                return std::nullopt;
            case trigger:
            case others:
            case more:
                return std::nullopt;
            default:
                return "a word of kind " + std::to_string(word >> 28) +
                       ", which EVT2 does not define";
        }
    }

    std::string describe(std::uint32_t word) const {
        const auto x = word >> 11 & 0x7ff;
        const auto y = word & 0x7ff;
        if (!time_is_known_) return "an event before the first TIME_HIGH has no time";
        if (x >= settings_.geometry.width || y >= settings_.geometry.height) {
            return outside(x, y, settings_);
        }
        return time_goes_back(last_t_us_, base_us_ + (word >> 22 & 63));
    }

    ByteWindow bytes_;
    RawSettings settings_;
    Unwrapped<28> high_;
    std::int64_t base_us_ = 0;    // of TIME_HIGH
    std::int64_t last_t_us_ = 0;  // of an event or of TIME_HIGH
    bool time_is_known_ = false;
};

}  // namespace

std::unique_ptr<EventReader> make_evt2_reader(ByteWindow bytes, const RawSettings& settings) {
    return std::make_unique<Evt2Reader>(std::move(bytes), settings);
}

}  // namespace pursuit::sensor
