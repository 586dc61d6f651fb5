// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/dat_reader.hpp"

#include <algorithm>
#include <utility>

#include "services/sensor/formats/dat_header.hpp"
#include "services/sensor/formats/event_lanes.hpp"
#include "services/sensor/formats/records.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t dat_event_bytes = 8;
constexpr Geometry atis{304, 240};

/// The parts of an address, or of four side by side.
struct Version1 {
    template <class Address>
    static Address x(Address address) {
        return address & 0x1ff;
    }
    template <class Address>
    static Address y(Address address) {
        return shift_right(address, 9) & 0xff;
    }
    template <class Address>
    static Address polarity(Address address) {
        return shift_right(address, 17) & 1;
    }
};

struct Version2 {
    template <class Address>
    static Address x(Address address) {
        return address & 0x3fff;
    }
    template <class Address>
    static Address y(Address address) {
        return shift_right(address, 14) & 0x3fff;
    }
    template <class Address>
    static Address polarity(Address address) {
        return shift_right(address, 28);
    }
};

struct Word {
    std::uint32_t t_us;
    std::uint32_t address;
};

Word word_at(const std::uint8_t* bytes) { return load<Word>(bytes); }

template <class Version>
class DatReader final : public EventReader {
 public:
    DatReader(ByteWindow bytes, Geometry geometry, bool geometry_is_stated)
        : bytes_(std::move(bytes)), geometry_(geometry), geometry_is_stated_(geometry_is_stated) {}

    Geometry geometry() const override { return geometry_; }

 protected:
    Decoded decode(std::span<Event> events, std::span<Event> /*exposures*/) override {
        Decoded done;
        const auto records = records_ahead(bytes_, dat_event_bytes, "an event");
        if (!records) {
            done.error = records.error();
            return done;
        }
        events = events.first(std::min(records->size() / dat_event_bytes, events.size()));
        const auto* bytes = records->data();
        while (done.count < events.size() && !done.error) {
            const auto wanted = std::min(events.size() - done.count, block_events);
            const auto good = decode_block(bytes, events.subspan(done.count, wanted));
            bytes += good * dat_event_bytes;
            done.count += good;
            bytes_.consume(good * dat_event_bytes);
            if (good < wanted) done.error = describe(word_at(bytes));
        }
        return done;
    }

 private:
    static constexpr std::size_t block_events = 1024;

    bool fits(Word word) const {
        return Version::x(word.address) < geometry_.width &&
               Version::y(word.address) < geometry_.height && Version::polarity(word.address) <= 1;
    }

    static constexpr std::int64_t range_us = std::int64_t{1} << 32;
    static constexpr std::uint32_t half_range_us = 0x8000'0000;

    bool wraps(Word word) const {
        return word.t_us < last_t_us_ && last_t_us_ - word.t_us > half_range_us;
    }
    /// Whether it is late, from before the last wrap.
    bool unwraps(Word word) const {
        return epoch_us_ > 0 && word.t_us > last_t_us_ && word.t_us - last_t_us_ > half_range_us;
    }

    /// Decodes events until the first bad one and returns how many are good. The common case has
    /// no branch: only a block that breaks a rule, or wraps, is looked at event by event.
    std::size_t decode_block(const std::uint8_t* bytes, std::span<Event> events) {
        const auto width = lanes_of(geometry_.width);
        const auto height = lanes_of(geometry_.height);
        const auto epoch = lanes_of(static_cast<std::uint32_t>(epoch_us_ >> 32));
        const auto fours = events.size() / 4 * 4;
        auto last = static_cast<std::int32_t>(last_t_us_);
        Lanes bad = {};
        for (std::size_t i = 0; i < fours; i += 4) {
            const auto first = load_lanes(bytes + i * dat_event_bytes);
            const auto second = load_lanes(bytes + (i + 2) * dat_event_bytes);
            const auto t_us = __builtin_shufflevector(first, second, 0, 2, 4, 6);
            const auto address = __builtin_shufflevector(first, second, 1, 3, 5, 7);
            const auto x = Version::x(address);
            const auto y = Version::y(address);
            const auto polarity = Version::polarity(address);
            bad |= less_unsigned(t_us, moved_on(t_us, last)) | (x >= width) | (y >= height) |
                   (polarity > 1);
            last = t_us[3];
            store_four(&events[i], t_us, epoch, x, y, polarity);
        }
        const auto last_t_us = static_cast<std::uint32_t>(last);
        // In a block without a fall, one such rise is one of the whole.
        if (any(bad) || last_t_us - last_t_us_ > half_range_us) {
            return decode_one_by_one(bytes, events);
        }
        last_t_us_ = last_t_us;
        return fours + decode_one_by_one(bytes + fours * dat_event_bytes, events.subspan(fours));
    }

    std::size_t decode_one_by_one(const std::uint8_t* bytes, std::span<Event> events) {
        for (std::size_t i = 0; i < events.size(); ++i) {
            const Word word = word_at(bytes + i * dat_event_bytes);
            if (!fits(word)) return i;
            if (wraps(word)) {
                epoch_us_ += range_us;
            } else if (word.t_us < last_t_us_ || unwraps(word)) {
                return i;
            }
            last_t_us_ = word.t_us;
            store(events[i], epoch_us_ + word.t_us, Version::x(word.address),
                  Version::y(word.address), Version::polarity(word.address));
        }
        return events.size();
    }

    Error describe(Word word) const {
        std::string cause;
        if (fits(word)) {
            const auto t_us = epoch_us_ + word.t_us - (unwraps(word) ? range_us : 0);
            cause = time_goes_back(epoch_us_ + last_t_us_, t_us);
        } else if (Version::polarity(word.address) > 1) {
            cause =
                "polarity " + std::to_string(Version::polarity(word.address)) + " is not 0 or 1";
        } else {
            cause = outside(Version::x(word.address), Version::y(word.address), geometry_);
            if (!geometry_is_stated_) cause += ", assumed because the header states no size";
        }
        return error_at(bytes_.name(), bytes_.offset(), cause);
    }

    ByteWindow bytes_;
    Geometry geometry_;
    bool geometry_is_stated_;
    std::int64_t epoch_us_ = 0;    // what the wraps so far have added
    std::uint32_t last_t_us_ = 0;  // as stored in the file
};

/// The version that the first events are written in.
Result<int> guess_version(ByteWindow& bytes) {
    const auto ahead = bytes.ahead(1 << 16);
    if (!ahead) return tl::unexpected(ahead.error());
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i + dat_event_bytes <= ahead->size(); i += dat_event_bytes) {
        bits |= word_at(ahead->data() + i).address;
    }
    return (bits >> 18) != 0 ? 2 : 1;
}

}  // namespace

bool looks_like_dat(std::string_view head) {
    return head.substr(0, 1) == "%" && head.find("% evt") == std::string_view::npos &&
           head.find("% format") == std::string_view::npos;
}

Result<std::unique_ptr<EventReader>> open_dat(ByteWindow bytes, const ReadOptions& options) {
    const auto header = read_dat_header(bytes);
    if (!header) return tl::unexpected(header.error());
    const auto version = header->version ? Result<int>(*header->version) : guess_version(bytes);
    if (!version) return tl::unexpected(version.error());
    const auto stated = options.geometry ? options.geometry : header->geometry;
    const auto geometry = stated.value_or(atis);
    std::unique_ptr<EventReader> reader;
    if (*version == 1) {
        reader = std::make_unique<DatReader<Version1>>(std::move(bytes), geometry, !!stated);
    } else {
        reader = std::make_unique<DatReader<Version2>>(std::move(bytes), geometry, !!stated);
    }
    return reader;
}

}  // namespace pursuit::sensor
