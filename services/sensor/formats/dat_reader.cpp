// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/dat_reader.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>
#include <utility>

#include "services/sensor/formats/dat_header.hpp"

namespace pursuit::sensor {
namespace {

static_assert(std::endian::native == std::endian::little, "the decoder reads words as they lie");

constexpr std::size_t event_bytes = 8;
constexpr Geometry atis{304, 240};

struct Version1 {
    static constexpr std::uint32_t x(std::uint32_t address) { return address & 0x1ff; }
    static constexpr std::uint32_t y(std::uint32_t address) { return (address >> 9) & 0xff; }
    static constexpr std::uint32_t polarity(std::uint32_t address) { return (address >> 17) & 1; }
};

struct Version2 {
    static constexpr std::uint32_t x(std::uint32_t address) { return address & 0x3fff; }
    static constexpr std::uint32_t y(std::uint32_t address) { return (address >> 14) & 0x3fff; }
    static constexpr std::uint32_t polarity(std::uint32_t address) { return address >> 28; }
};

struct Word {
    std::uint32_t t_us;
    std::uint32_t address;
};

Word word_at(const std::uint8_t* bytes) {
    Word word;
    std::memcpy(&word, bytes, sizeof word);
    return word;
}

template <class Version>
class DatReader final : public EventReader {
 public:
    DatReader(ByteWindow bytes, Geometry geometry, bool geometry_is_stated)
        : bytes_(std::move(bytes)), geometry_(geometry), geometry_is_stated_(geometry_is_stated) {}

    Geometry geometry() const override { return geometry_; }

 protected:
    Decoded decode(std::span<Event> events, std::span<Event> /*exposures*/) override {
        Decoded done;
        const auto ahead = bytes_.ahead(event_bytes);
        if (!ahead) {
            done.error = ahead.error();
            return done;
        }
        const auto whole = ahead->size() / event_bytes;
        if (whole == 0 && !ahead->empty()) {
            done.error = error_at(bytes_.name(), bytes_.offset(),
                                  "the file ends within an event, after " +
                                      std::to_string(ahead->size()) + " of 8 bytes");
        }
        events = events.first(std::min(whole, events.size()));
        const auto* bytes = ahead->data();
        while (done.count < events.size() && !done.error) {
            const auto wanted = std::min(events.size() - done.count, block_events);
            const auto good = decode_block(bytes, events.subspan(done.count, wanted));
            bytes += good * event_bytes;
            done.count += good;
            bytes_.consume(good * event_bytes);
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

    bool wraps(Word word) const { return last_t_us_ - word.t_us > 0x8000'0000U; }

    /// Decodes events until the first bad one and returns how many are good. The common case has
    /// no branch: only a block that breaks a rule, or wraps, is looked at event by event.
    std::size_t decode_block(const std::uint8_t* bytes, std::span<Event> events) {
        const std::uint32_t width = geometry_.width;
        const std::uint32_t height = geometry_.height;
        std::uint32_t last = last_t_us_;
        std::uint32_t bad = 0;
        for (std::size_t i = 0; i < events.size(); ++i) {
            const Word word = word_at(bytes + i * event_bytes);
            const auto x = Version::x(word.address);
            const auto y = Version::y(word.address);
            const auto polarity = Version::polarity(word.address);
            bad |= static_cast<std::uint32_t>(word.t_us < last) |
                   static_cast<std::uint32_t>(x >= width) |
                   static_cast<std::uint32_t>(y >= height) | (polarity >> 1);
            last = word.t_us;
            store(events[i], epoch_us_ + word.t_us, x, y, polarity);
        }
        if (bad != 0) return decode_one_by_one(bytes, events);
        last_t_us_ = last;
        return events.size();
    }

    std::size_t decode_one_by_one(const std::uint8_t* bytes, std::span<Event> events) {
        for (std::size_t i = 0; i < events.size(); ++i) {
            const Word word = word_at(bytes + i * event_bytes);
            if (!fits(word)) return i;
            if (word.t_us < last_t_us_) {
                if (!wraps(word)) return i;
                epoch_us_ += std::int64_t{1} << 32;
            }
            last_t_us_ = word.t_us;
            store(events[i], epoch_us_ + word.t_us, Version::x(word.address),
                  Version::y(word.address), Version::polarity(word.address));
        }
        return events.size();
    }

    /// Two stores of 8 bytes instead of one a member.
    static void store(Event& event, std::int64_t t_us, std::uint32_t x, std::uint32_t y,
                      std::uint32_t polarity) {
        static_assert(sizeof(Event) == 16 && std::is_trivially_copyable_v<Event> &&
                      offsetof(Event, x) == 8 && offsetof(Event, y) == 10 &&
                      offsetof(Event, polarity) == 12);
        const std::uint64_t words[2] = {static_cast<std::uint64_t>(t_us),
                                        x | y << 16 | std::uint64_t{polarity} << 32};
        std::memcpy(static_cast<void*>(&event), words, sizeof words);
    }

    Error describe(Word word) const {
        std::string cause;
        if (fits(word)) {
            cause = "time goes back from " + std::to_string(last_t_us_) + " to " +
                    std::to_string(word.t_us) + " us";
        } else if (Version::polarity(word.address) > 1) {
            cause =
                "polarity " + std::to_string(Version::polarity(word.address)) + " is not 0 or 1";
        } else {
            cause = "pixel (" + std::to_string(Version::x(word.address)) + ", " +
                    std::to_string(Version::y(word.address)) + ") is outside " +
                    std::to_string(geometry_.width) + "x" + std::to_string(geometry_.height);
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
    for (std::size_t i = 0; i + event_bytes <= ahead->size(); i += event_bytes) {
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
