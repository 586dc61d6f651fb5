// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

#include "services/common/event.hpp"
#include "services/common/result.hpp"
#include "services/sensor/formats/byte_source.hpp"
#include "services/sensor/formats/event_reader.hpp"

namespace pursuit::sensor {

static_assert(std::endian::native == std::endian::little, "the decoders read words as they lie");

/// The whole records of `size` bytes ahead: one at least, none at the end. `what` a record is, for
/// the error where the source ends within one.
inline Result<std::span<const std::uint8_t>> records_ahead(ByteWindow& bytes, std::size_t size,
                                                           const char* what) {
    const auto ahead = bytes.ahead(size);
    if (!ahead) return tl::unexpected(ahead.error());
    if (ahead->size() < size && !ahead->empty()) {
        return tl::unexpected(error_at(bytes.name(), bytes.offset(),
                                       std::string("the file ends within ") + what + ", after " +
                                           std::to_string(ahead->size()) + " of " +
                                           std::to_string(size) + " bytes"));
    }
    return ahead->first(ahead->size() / size * size);
}

/// The little-endian word at `bytes`, at any alignment.
template <class Word>
Word load(const std::uint8_t* bytes) {
    Word word;
    std::memcpy(&word, bytes, sizeof word);
    return word;
}

/// event = {t_us, x, y, polarity} in two stores of 8 bytes instead of one a member.
inline void store(Event& event, std::int64_t t_us, std::uint32_t x, std::uint32_t y,
                  std::uint32_t polarity) {
    static_assert(sizeof(Event) == 16 && std::is_trivially_copyable_v<Event> &&
                  offsetof(Event, x) == 8 && offsetof(Event, y) == 10 &&
                  offsetof(Event, polarity) == 12);
    const std::uint64_t words[2] = {static_cast<std::uint64_t>(t_us),
                                    x | y << 16 | std::uint64_t{polarity} << 32};
    std::memcpy(static_cast<void*>(&event), words, sizeof words);
}

/// What is wrong with an event, as every format says it.
inline std::string outside(std::uint32_t x, std::uint32_t y, Geometry geometry) {
    return "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") is outside " +
           std::to_string(geometry.width) + "x" + std::to_string(geometry.height);
}

inline std::string time_too_late(std::int64_t t_us) {
    return "time " + std::to_string(t_us) + " us is not below 2^53 us";
}

inline std::string time_goes_back(std::int64_t from_us, std::int64_t to_us) {
    return "time goes back from " + std::to_string(from_us) + " to " + std::to_string(to_us) +
           " us";
}

}  // namespace pursuit::sensor
