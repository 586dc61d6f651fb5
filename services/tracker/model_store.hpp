// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/common/result.hpp"
#include "services/tracker/core/registration.hpp"

namespace pursuit::tracker {

/// What requests have set beside the objects; configuration holds for the rest.
struct RequestedSettings {
    std::optional<StrategyKind> strategy;
    std::vector<NamedValue> strategy_parameters;
    std::vector<NamedValue> parameters;  ///< The tracker's and those of new objects; one a name.

    friend bool operator==(const RequestedSettings&, const RequestedSettings&) = default;
};

struct StoredObject {
    RegisteredObject object;
    std::optional<TrackSnapshot> track;  ///< Where it was last tracked.
};

/// When a state was: how far the events behind it went.
struct StoredMoment {
    std::uint64_t stream_id = 0;
    std::int64_t last_t_us = -1;

    friend bool operator==(const StoredMoment&, const StoredMoment&) = default;
};

/// What a tracker keeps between two runs.
struct StoredState {
    StoredMoment moment;
    std::uint32_t next_object_id = 1;
    RequestedSettings settings;
    std::vector<StoredObject> objects;  ///< In order of ids.
};

/// The store as one file: a Store message (idl/store.proto) in binary form, because every number
/// comes back bit for bit and the checksum is over the very bytes of the file. Its last field is
/// the CRC-32 of all before it.
std::string encode_store(const StoredState& state);

/// Refuses bytes whose checksum, format or content is wrong, naming the field.
Result<StoredState> decode_store(std::string_view bytes);

/// What was found where a store should be: nothing where no file is, nor where it was damaged.
struct FoundStore {
    std::optional<StoredState> state;
    std::string damage;  ///< Of the file, which is "<path>.damaged" now; empty where it is good.
};

/// An error where a file is or may be that cannot be read, or neither understood nor kept aside:
/// another must not be written over it.
Result<FoundStore> read_store(const std::string& path);

Result<void> write_store(const std::string& path, const StoredState& state);

}  // namespace pursuit::tracker
