// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/evt21_reader.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <string>
#include <utility>

namespace pursuit::sensor {
namespace {

constexpr std::size_t word_bytes = 8;

enum Kind : std::uint32_t { off = 0, on = 1, time_high = 8, trigger = 10, others = 14, more = 15 };

class Evt21Reader final : public EventReader {
 public:
    Evt21Reader(ByteWindow bytes, const RawSettings& settings, bool halves_swapped)
        : bytes_(std::move(bytes)), settings_(settings), rotation_(halves_swapped ? 32 : 0) {}

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
            const auto word = std::rotl(load<std::uint64_t>(at), rotation_);
            const auto cause =
                word >> 60 <= on ? take_events(word, events, done) : take_other(word);
            if (cause) {
                done.error =
                    error_at(bytes_.name(), bytes_.offset() + (at - words->data()), *cause);
                break;
            }
            // A word whose events did not all fit is ahead again.
            if (taken_of_word_ != 0) break;
            at += word_bytes;
        }
        bytes_.consume(static_cast<std::size_t>(at - words->data()));
        done.time_us = last_t_us_;
        done.goes_on = true;
        return done;
    }

 private:
    std::optional<std::string> take_events(std::uint64_t word, std::span<Event> events,
                                           Decoded& done) {
        const auto valid = static_cast<std::uint32_t>(word);
        if (!time_is_known_) {
            if (!settings_.joined_late) return "an event before the first TIME_HIGH has no time";
            done.skipped += static_cast<std::uint64_t>(std::popcount(valid));
            return std::nullopt;
        }
        const auto first_x = static_cast<std::uint32_t>(word >> 43 & 0x7ff);
        const auto y = static_cast<std::uint32_t>(word >> 32 & 0x7ff);
        const auto polarity = static_cast<std::uint32_t>(word >> 60);
        const auto t_us = base_us_ + static_cast<std::int64_t>(word >> 54 & 63);
        for (auto rest = valid & ~taken_of_word_; rest != 0; rest &= rest - 1) {
            const auto x = first_x + static_cast<std::uint32_t>(std::countr_zero(rest));
            if (x >= settings_.geometry.width || y >= settings_.geometry.height) {
                return outside(x, y, settings_);
            }
            if (t_us < last_t_us_) return time_goes_back(last_t_us_, t_us);
            if (done.count == events.size()) {
                taken_of_word_ = valid & ~rest;
                return std::nullopt;
            }
            store(events[done.count++], t_us, x, y, polarity);
            last_t_us_ = t_us;
        }
        taken_of_word_ = 0;
        return std::nullopt;
    }

    std::optional<std::string> take_other(std::uint64_t word) {
        switch (word >> 60) {
            case time_high:
                high_.set(static_cast<std::int64_t>(word >> 32 & 0xfff'ffff));
                base_us_ = high_.value() * 64;
                last_t_us_ = std::max(last_t_us_, base_us_);
                time_is_known_ = true;
                return std::nullopt;
            case trigger:
            case others:
            case more:
                return std::nullopt;
            default:
                return "a word of kind " + std::to_string(word >> 60) +
                       ", which EVT2.1 does not define";
        }
    }

    ByteWindow bytes_;
    RawSettings settings_;
    int rotation_;
    Unwrapped<28> high_;
    std::int64_t base_us_ = 0;         // of TIME_HIGH
    std::int64_t last_t_us_ = 0;       // of an event or of TIME_HIGH
    std::uint32_t taken_of_word_ = 0;  // the events of the word ahead that are delivered already
    bool time_is_known_ = false;
};

}  // namespace

std::unique_ptr<EventReader> make_evt21_reader(ByteWindow bytes, const RawSettings& settings,
                                               bool halves_swapped) {
    return std::make_unique<Evt21Reader>(std::move(bytes), settings, halves_swapped);
}

}  // namespace pursuit::sensor
