// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>

namespace pursuit {

/// The 12 octets that the GUIDs of a participant's readers and writers begin with.
using ParticipantKey = std::array<std::uint8_t, 12>;

/// A request's identity in a form that can be compared: the writer's GUID and its count.
struct RequestKey {
    std::array<std::uint8_t, 16> writer_guid{};
    std::int64_t sequence = 0;

    auto operator<=>(const RequestKey&) const = default;
};

inline ParticipantKey participant_of(const RequestKey& key) {
    ParticipantKey participant{};
    std::copy_n(key.writer_guid.begin(), participant.size(), participant.begin());
    return participant;
}

}  // namespace pursuit
