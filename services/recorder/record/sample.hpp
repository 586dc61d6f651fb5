// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pursuit::recorder {

/// The 16 octets of a DDS GUID: the prefix's 12, then the entity's 4.
using Guid = std::array<std::uint8_t, 16>;

/// Which sample of which writer; sequence 0: none.
struct SampleId {
    Guid writer{};
    std::int64_t sequence = 0;

    friend auto operator<=>(const SampleId&, const SampleId&) = default;
};

/// 32 hexadecimal digits, small letters.
inline std::string to_hex(const Guid& guid) {
    constexpr auto digits = "0123456789abcdef";
    std::string text;
    for (const auto octet : guid) {
        text += digits[octet >> 4];
        text += digits[octet & 15];
    }
    return text;
}

enum class SampleKind : std::uint8_t { data, disposed, unregistered };

/// One sample as it was received: its payload unchanged, and what came beside it.
struct Sample {
    std::size_t topic = 0;  ///< Index into the topics that are recorded.
    SampleKind kind = SampleKind::data;
    SampleId id;
    SampleId related;  ///< Of a reply: the request it answers, where DDS carries it.
    std::int64_t reception_time_ns = 0;  ///< CLOCK_REALTIME.
    std::int64_t source_time_ns = -1;    ///< By the writer's clock; negative: not known.
    Guid instance{};                     ///< Key hash; of keyed topics only.
    std::vector<std::uint8_t> payload;   ///< With the 4 octets of encapsulation; data only.
};

}  // namespace pursuit::recorder
