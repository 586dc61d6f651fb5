// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/packet_fields.hpp"

#include <algorithm>

namespace pursuit::recorder {
namespace {

constexpr std::size_t header_bytes = 4;    // encapsulation
constexpr std::size_t words_offset = 72;   // 68, aligned to 8
constexpr std::size_t empty_bytes = 68;    // without words there is no alignment for them
constexpr std::uint64_t max_words = 8000;  // idl/events.idl

}  // namespace

std::optional<PacketFields> PacketFields::of(std::span<const std::uint8_t> payload) {
    if (payload.size() < header_bytes + empty_bytes) return std::nullopt;
    if (payload[0] != 0 || payload[1] > 1) return std::nullopt;
    const PacketFields fields(payload, payload[1] == 1);
    const std::uint64_t words = fields.words();
    if (words > max_words) return std::nullopt;
    if (words > 0 && payload.size() < header_bytes + words_offset + 8 * words) return std::nullopt;
    return fields;
}

std::int64_t PacketFields::first_us() const {
    if (words() == 0) return base_time_us();
    return base_time_us() + static_cast<std::int64_t>(read(words_offset, 8) >> 32);
}

std::int64_t PacketFields::reached_us() const {
    const auto base_us = base_time_us();
    const std::size_t count = words();
    if (count == 0) return base_us;
    const auto last = read(words_offset + 8 * (count - 1), 8);
    return base_us + static_cast<std::int64_t>(last >> 32);
}

std::uint64_t PacketFields::read(std::size_t offset, std::size_t size) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const std::uint64_t octet = payload_[header_bytes + offset + i];
        value |= octet << (8 * (little_endian_ ? i : size - 1 - i));
    }
    return value;
}

void PacketFields::write(std::span<std::uint8_t> payload, std::size_t offset,
                         std::uint64_t value) const {
    for (std::size_t i = 0; i < 8; ++i) {
        payload[header_bytes + offset + i] =
            static_cast<std::uint8_t>(value >> (8 * (little_endian_ ? i : 7 - i)));
    }
}

}  // namespace pursuit::recorder
