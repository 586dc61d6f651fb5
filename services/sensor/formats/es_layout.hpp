// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace pursuit::sensor::es {

/// The bytes of Event Stream 2 (es_reader.hpp).
constexpr std::string_view magic = "Event Stream";
constexpr std::size_t version_at = 12;
constexpr std::size_t type_at = 15;
constexpr std::size_t size_at = 16;
constexpr std::size_t header_bytes = 20;
constexpr std::size_t event_bytes = 5;

/// The first byte of a DVS event, or a byte of time.
struct Dvs {
    static constexpr std::uint8_t type = 1;
    static constexpr bool has_exposures = false;
    static constexpr std::int64_t unit_us = 127;  ///< Bytes of time add multiples of this.
    static constexpr std::int64_t most_units = 1;
    static constexpr std::uint8_t no_units = 0xfe;

    static constexpr bool is_time(std::uint8_t first) { return first >= no_units; }
    static constexpr std::int64_t time_us(std::uint8_t first) { return unit_us * (first & 1); }
    static constexpr std::int64_t delta_us(std::uint8_t first) { return first >> 1; }
    static constexpr std::uint32_t polarity(std::uint8_t first) { return first & 1; }
    static constexpr bool is_exposure(std::uint8_t /*first*/) { return false; }
    static constexpr std::uint8_t first(std::int64_t delta_us, unsigned polarity,
                                        bool /*is_exposure*/) {
        return static_cast<std::uint8_t>(static_cast<unsigned>(delta_us) << 1 | polarity);
    }
};

/// The first byte of an ATIS event or exposure measurement, or a byte of time.
struct Atis {
    static constexpr std::uint8_t type = 2;
    static constexpr bool has_exposures = true;
    static constexpr std::int64_t unit_us = 63;
    static constexpr std::int64_t most_units = 3;
    static constexpr std::uint8_t no_units = 0xfc;

    static constexpr bool is_time(std::uint8_t first) { return first >= no_units; }
    static constexpr std::int64_t time_us(std::uint8_t first) { return unit_us * (first & 3); }
    static constexpr std::int64_t delta_us(std::uint8_t first) { return first >> 2; }
    static constexpr std::uint32_t polarity(std::uint8_t first) { return (first >> 1) & 1; }
    static constexpr bool is_exposure(std::uint8_t first) { return (first & 1) != 0; }
    static constexpr std::uint8_t first(std::int64_t delta_us, unsigned polarity,
                                        bool is_exposure) {
        return static_cast<std::uint8_t>(static_cast<unsigned>(delta_us) << 2 | polarity << 1 |
                                         static_cast<unsigned>(is_exposure));
    }
};

}  // namespace pursuit::sensor::es
