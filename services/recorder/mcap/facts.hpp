// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/common/result.hpp"
#include "services/recorder/mcap/records.hpp"

/// What a recording says beyond the MCAP format, so that a replay can offer the same topics again.
/// It is all in the channels, hence written before their first message.
namespace pursuit::recorder::mcap {

/// Encodings of the channels that a recorder writes.
inline constexpr std::string_view schema_encoding = "omgidl";
inline constexpr std::string_view message_encoding =
    "cdr";  ///< With the 4 octets of encapsulation.

enum class Reliability { best_effort, reliable };
enum class Durability { volatile_, transient_local };
enum class Ownership { shared, exclusive };

/// How a topic was offered. In Channel::metadata as "pursuit.type", "pursuit.keyed",
/// "pursuit.partitions" (one a line), "pursuit.reliability", "pursuit.durability",
/// "pursuit.history_depth" (0: keep all), "pursuit.ownership", "pursuit.deadline_ns" (0: none) and,
/// where messages are kept apart by writer, "pursuit.writer_guid" (32 hex digits).
struct ReplayFacts {
    std::string type_name;  ///< As DDS has it: "pursuit::v1::EventPacket".
    bool keyed = false;
    std::vector<std::string> partitions;  ///< Empty: the default partition.
    Reliability reliability = Reliability::reliable;
    Durability durability = Durability::volatile_;
    std::uint32_t history_depth = 1;
    Ownership ownership = Ownership::shared;
    std::int64_t deadline_ns = 0;
    std::string writer_guid;

    friend bool operator==(const ReplayFacts&, const ReplayFacts&) = default;
};

/// Partition names may not contain a line feed; it is written as a space.
StringMap to_metadata(const ReplayFacts& facts);

/// Nothing where the channel is not one of ours (no "pursuit.type"); an error names the key whose
/// value cannot be read.
Result<std::optional<ReplayFacts>> replay_facts(const Channel& channel);

/// The end of an instance: a dispose, an unregistration, or both in one sample. They are messages
/// of a channel of their own beside the topic's: same topic and metadata, this message encoding, no
/// schema, because they are no samples of the topic's type and a viewer should leave them out.
///
/// Content: 1 octet of flags (bit 0 disposed, bit 1 unregistered, bit 2 key hash present), 16
/// octets of key hash (zeros where absent), then the serialized key with its encapsulation, or
/// nothing.
struct InstanceState {
    bool disposed = false;
    bool unregistered = false;
    std::optional<std::array<std::uint8_t, 16>> key_hash;
    Bytes key;

    friend bool operator==(const InstanceState&, const InstanceState&) = default;
};
inline constexpr std::string_view instance_state_encoding = "pursuit.instance_state.v1";

Bytes encode(const InstanceState& state);

}  // namespace pursuit::recorder::mcap
