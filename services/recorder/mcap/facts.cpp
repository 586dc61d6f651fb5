// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/facts.hpp"

#include <algorithm>
#include <charconv>

namespace pursuit::recorder::mcap {
namespace {

constexpr std::uint8_t disposed_flag = 1;
constexpr std::uint8_t unregistered_flag = 2;
constexpr std::uint8_t key_hash_flag = 4;

const std::string* find(const Channel& channel, const char* key) {
    const auto place = channel.metadata.find(key);
    return place == channel.metadata.end() ? nullptr : &place->second;
}

tl::unexpected<Error> unreadable(const Channel& channel, const std::string& key,
                                 const std::string& value) {
    return fail("channel " + channel.topic + ": metadata " + key + " is \"" + value.substr(0, 64) +
                "\", which cannot be read");
}

/// Reads one of two words; keeps `value` where the key is absent.
template <class T>
Result<void> read_word(const Channel& channel, const char* key, const char* first,
                       const char* second, T& value) {
    const auto* text = find(channel, key);
    if (text == nullptr) return {};
    if (*text != first && *text != second) return unreadable(channel, key, *text);
    value = *text == first ? static_cast<T>(0) : static_cast<T>(1);
    return {};
}

template <class T>
Result<void> read_number(const Channel& channel, const char* key, T& value) {
    const auto* text = find(channel, key);
    if (text == nullptr) return {};
    T number{};
    const auto* end = text->data() + text->size();
    const auto [stop, error] = std::from_chars(text->data(), end, number);
    if (error != std::errc() || stop != end || number < 0) return unreadable(channel, key, *text);
    value = number;
    return {};
}

}  // namespace

StringMap to_metadata(const ReplayFacts& facts) {
    std::string partitions;
    for (std::string name : facts.partitions) {
        std::replace(name.begin(), name.end(), '\n', ' ');
        partitions += name + "\n";
    }
    StringMap map = {
        {"pursuit.type", facts.type_name},
        {"pursuit.keyed", facts.keyed ? "true" : "false"},
        {"pursuit.partitions", partitions},
        {"pursuit.reliability",
         facts.reliability == Reliability::reliable ? "reliable" : "best_effort"},
        {"pursuit.durability",
         facts.durability == Durability::volatile_ ? "volatile" : "transient_local"},
        {"pursuit.history_depth", std::to_string(facts.history_depth)},
        {"pursuit.ownership", facts.ownership == Ownership::shared ? "shared" : "exclusive"},
        {"pursuit.deadline_ns", std::to_string(facts.deadline_ns)},
    };
    if (!facts.writer_guid.empty()) map["pursuit.writer_guid"] = facts.writer_guid;
    return map;
}

Result<std::optional<ReplayFacts>> replay_facts(const Channel& channel) {
    const auto* type = find(channel, "pursuit.type");
    if (type == nullptr) return std::optional<ReplayFacts>();
    ReplayFacts facts;
    facts.type_name = *type;
    if (const auto* names = find(channel, "pursuit.partitions")) {
        for (std::size_t begin = 0; begin < names->size();) {
            const auto end = std::min(names->find('\n', begin), names->size());
            facts.partitions.push_back(names->substr(begin, end - begin));
            begin = end + 1;
        }
    }
    if (const auto* guid = find(channel, "pursuit.writer_guid")) facts.writer_guid = *guid;
    auto ok = read_word(channel, "pursuit.keyed", "false", "true", facts.keyed);
    if (ok) {
        ok =
            read_word(channel, "pursuit.reliability", "best_effort", "reliable", facts.reliability);
    }
    if (ok) {
        ok = read_word(channel, "pursuit.durability", "volatile", "transient_local",
                       facts.durability);
    }
    if (ok) ok = read_word(channel, "pursuit.ownership", "shared", "exclusive", facts.ownership);
    if (ok) ok = read_number(channel, "pursuit.history_depth", facts.history_depth);
    if (ok) ok = read_number(channel, "pursuit.deadline_ns", facts.deadline_ns);
    if (!ok) return tl::unexpected(ok.error());
    return facts;
}

Bytes encode(const InstanceState& state) {
    Bytes data;
    data.reserve(17 + state.key.size());
    ByteWriter out(data);
    out.u8(static_cast<std::uint8_t>((state.disposed ? disposed_flag : 0) |
                                     (state.unregistered ? unregistered_flag : 0) |
                                     (state.key_hash ? key_hash_flag : 0)));
    out.bytes(state.key_hash.value_or(std::array<std::uint8_t, 16>{}));
    out.bytes(state.key);
    return data;
}

}  // namespace pursuit::recorder::mcap
