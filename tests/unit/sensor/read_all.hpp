// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "services/sensor/formats/event_reader.hpp"
#include "services/sensor/formats/formats.hpp"
#include "tests/unit/sensor/chunk_source.hpp"

namespace pursuit::sensor {

/// Everything a reader gives, and the error it ends with, empty for none.
struct ReadAll {
    std::vector<Event> events;
    std::string error = {};
    std::vector<Event> exposures = {};
    std::uint64_t skipped = 0;
};

inline ReadAll read_all(EventReader& reader, std::size_t at_a_time = 1000) {
    ReadAll all;
    std::vector<Event> block(at_a_time);
    for (;;) {
        const auto count = reader.read(block);
        all.skipped = reader.events_skipped();
        if (!count) {
            all.error = count.error().message;
            return all;
        }
        if (*count == 0) return all;
        all.events.insert(all.events.end(), block.begin(),
                          block.begin() + static_cast<std::ptrdiff_t>(*count));
    }
}

/// The same with exposure measurements; says so where a later call gives what is earlier.
inline ReadAll read_both(EventReader& reader, std::size_t at_a_time = 1000) {
    ReadAll all;
    std::vector<Event> events(at_a_time);
    std::vector<Event> exposures(at_a_time);
    for (;;) {
        const auto before_us = reader.time_us();
        const auto batch = reader.read(events, exposures);
        all.skipped = reader.events_skipped();
        if (!batch) {
            all.error = batch.error().message;
            return all;
        }
        if (batch->at_end) return all;
        for (auto [block, count, into] :
             {std::tuple{&events, batch->events, &all.events},
              std::tuple{&exposures, batch->exposures, &all.exposures}}) {
            if (count > 0 && block->front().t_us < before_us) all.error = "out of order";
            into->insert(into->end(), block->begin(),
                         block->begin() + static_cast<std::ptrdiff_t>(count));
        }
    }
}

/// Everything that a file gives; also where it cannot be opened.
inline ReadAll read_file(const std::string& path) {
    auto reader = open_events(path);
    return reader ? read_all(**reader) : ReadAll{{}, reader.error().message};
}

/// What bytes decode to, those before an error included; also where they cannot be opened.
inline ReadAll decode_bytes(const std::string& name, const std::string& bytes,
                            const ReadOptions& options = {}, std::size_t at_a_time = 1000) {
    auto reader = open_events(
        from_memory(name, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}),
        options);
    if (!reader) return {{}, reader.error().message};
    return read_both(**reader, at_a_time);
}

/// The same where the bytes arrive `chunk_bytes` at a time.
inline ReadAll decode_chunks(const std::string& name, const std::string& bytes,
                             std::size_t chunk_bytes, const ReadOptions& options = {},
                             std::size_t at_a_time = 1000) {
    auto reader = open_events(ChunkSource::of(name, bytes, chunk_bytes), options);
    if (!reader) return {{}, reader.error().message};
    return read_both(**reader, at_a_time);
}

/// The octets of a number, lowest first.
template <class Word>
std::string little_endian(Word word) {
    std::string bytes;
    for (std::size_t i = 0; i < sizeof word; ++i) {
        bytes += static_cast<char>(word >> (8 * i) & 0xff);
    }
    return bytes;
}

}  // namespace pursuit::sensor
