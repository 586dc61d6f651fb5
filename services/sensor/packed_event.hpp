// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "services/common/event.hpp"

namespace pursuit::sensor {

/// The word of one event in a packet (idl/events.idl), most significant bit first: 32 bits of
/// t_us - base_time_us, 16 of x, 15 of y, 1 of polarity. Needs base_time_us <= t_us <
/// base_time_us + 2^32, y < 2^15, polarity 0 or 1.
constexpr std::uint64_t pack(const Event& event, std::int64_t base_time_us) {
    const auto offset_us = static_cast<std::uint64_t>(event.t_us - base_time_us);
    return offset_us << 32 | std::uint64_t{event.x} << 16 |
           static_cast<std::uint64_t>(event.y) << 1 | event.polarity;
}

/// The event of a word; any word gives an event.
constexpr Event unpack(std::uint64_t word, std::int64_t base_time_us) {
    return {base_time_us + static_cast<std::int64_t>(word >> 32),
            static_cast<std::uint16_t>(word >> 16), static_cast<std::uint16_t>(word >> 1 & 0x7fff),
            static_cast<std::uint8_t>(word & 1)};
}

}  // namespace pursuit::sensor
