// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>

#include "services/common/event.hpp"
#include "services/sensor/formats/records.hpp"

namespace pursuit::sensor {

/// Four words side by side, for decoders that take four events at a time: the vector extension that
/// gcc and clang share, on any processor.
using Lanes = std::int32_t __attribute__((vector_size(16)));
using UnsignedLanes = std::uint32_t __attribute__((vector_size(16)));

inline Lanes lanes_of(std::uint32_t value) {
    const auto lane = static_cast<std::int32_t>(value);
    return Lanes{lane, lane, lane, lane};
}

/// The four little-endian words at `bytes`, at any alignment.
inline Lanes load_lanes(const std::uint8_t* bytes) { return load<Lanes>(bytes); }

/// value >> count with zeros from above.
inline Lanes shift_right(Lanes value, unsigned count) {
    return reinterpret_cast<Lanes>(reinterpret_cast<UnsignedLanes>(value) >> count);
}
inline std::uint32_t shift_right(std::uint32_t value, unsigned count) { return value >> count; }

/// All bits of the lanes in which a < b as unsigned numbers.
inline Lanes less_unsigned(Lanes a, Lanes b) {
    return reinterpret_cast<Lanes>(reinterpret_cast<UnsignedLanes>(a) <
                                   reinterpret_cast<UnsignedLanes>(b));
}

/// The lanes one further on: {first, lanes[0], lanes[1], lanes[2]}.
inline Lanes moved_on(Lanes lanes, std::int32_t first) {
    return __builtin_shufflevector(lanes, Lanes{first}, 4, 0, 1, 2);
}

/// Whether any bit is set in any lane.
inline bool any(Lanes lanes) {
    std::uint64_t halves[2];
    std::memcpy(halves, &lanes, sizeof halves);
    return (halves[0] | halves[1]) != 0;
}

/// events[i] = {t_high * 2^32 + t_low[i], x[i], y[i], polarity[i]} of four events: what store()
/// writes, put together by rearranging lanes.
inline void store_four(Event* events, Lanes t_low, Lanes t_high, Lanes x, Lanes y, Lanes polarity) {
    const Lanes xy = x | y << 16;
    const Lanes times[2] = {__builtin_shufflevector(t_low, t_high, 0, 4, 1, 5),
                            __builtin_shufflevector(t_low, t_high, 2, 6, 3, 7)};
    const Lanes rests[2] = {__builtin_shufflevector(xy, polarity, 0, 4, 1, 5),
                            __builtin_shufflevector(xy, polarity, 2, 6, 3, 7)};
    for (int pair = 0; pair < 2; ++pair) {
        const Lanes two[2] = {__builtin_shufflevector(times[pair], rests[pair], 0, 1, 4, 5),
                              __builtin_shufflevector(times[pair], rests[pair], 2, 3, 6, 7)};
        std::memcpy(static_cast<void*>(events + 2 * pair), two, sizeof two);
    }
}

}  // namespace pursuit::sensor
