// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/chunk.hpp"

#include "services/recorder/mcap/compression.hpp"

namespace pursuit::recorder::mcap {
namespace {

std::string hex(std::uint32_t value) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text = "0x";
    for (int shift = 28; shift >= 0; shift -= 4) text += digits[(value >> shift) & 15];
    return text;
}

template <class T>
const T* find(const std::map<std::uint16_t, T>& map, std::uint16_t id) {
    const auto place = map.find(id);
    return place == map.end() ? nullptr : &place->second;
}

}  // namespace

template <class T>
Result<void> Definitions::put(std::map<std::uint16_t, T>& known, T added, const std::string& name,
                              std::size_t bytes, bool in_chunk) {
    const auto place = known.find(added.id);
    if (place != known.end()) {
        if (place->second == added) {
            if (in_chunk) from_chunks_.insert(name);
            return {};
        }
        if (in_chunk && from_chunks_.insert(name).second) place->second = std::move(added);
        return fail(name + " differs from its first record");
    }
    bytes_ += bytes;
    if (bytes_ > max_bytes_) {
        return fail("schemas and channels of more than " + std::to_string(max_bytes_) + " bytes");
    }
    if (in_chunk) from_chunks_.insert(name);
    known.emplace(added.id, std::move(added));
    return {};
}

Result<void> Definitions::add(Opcode opcode, ByteSpan content, bool in_chunk) {
    if (opcode == Opcode::schema) {
        Schema added;
        if (!parse(content, added)) return fail("the Schema record is malformed");
        if (added.id == 0) return {};  // The format: invalid, to be ignored.
        const std::string name = "schema " + std::to_string(added.id);
        return put(schemas_, std::move(added), name, content.size(), in_chunk);
    }
    Channel added;
    if (!parse(content, added)) return fail("the Channel record is malformed");
    const std::string name = "channel " + std::to_string(added.id);
    if (added.schema_id != 0 && schema(added.schema_id) == nullptr) {
        return fail(name + " refers to schema " + std::to_string(added.schema_id) +
                    ", which the file does not define");
    }
    return put(channels_, std::move(added), name, content.size(), in_chunk);
}

const Schema* Definitions::schema(std::uint16_t id) const { return find(schemas_, id); }
const Channel* Definitions::channel(std::uint16_t id) const { return find(channels_, id); }

Result<void> decode_chunk(ByteSpan content, const ReadLimits& limits, Chunk& chunk) {
    if (!parse(content, chunk.head)) return fail("the Chunk record is malformed");
    const auto& head = chunk.head;
    if (head.uncompressed_bytes > limits.uncompressed_bytes) {
        return fail("the chunk declares " + std::to_string(head.uncompressed_bytes) +
                    " bytes uncompressed; at most " + std::to_string(limits.uncompressed_bytes) +
                    " are read");
    }
    chunk.compressed_bytes = head.records.size();
    if (head.compression.empty()) {
        if (head.records.size() != head.uncompressed_bytes) {
            return fail("the chunk holds " + std::to_string(head.records.size()) +
                        " bytes and declares " + std::to_string(head.uncompressed_bytes));
        }
        chunk.records.assign(head.records.begin(), head.records.end());
    } else if (head.compression == name_of(Compression::zstd)) {
        chunk.records.resize(static_cast<std::size_t>(head.uncompressed_bytes));
        if (auto ok = zstd_decompress(head.records, chunk.records); !ok) {
            return fail("the chunk is damaged: " + ok.error().message);
        }
    } else {
        return fail("the chunk's compression is \"" + head.compression.substr(0, 32) +
                    "\"; zstd and none are read");
    }
    const auto crc = crc32(0, chunk.records);
    if (head.uncompressed_crc != 0 && head.uncompressed_crc != crc) {
        return fail("the chunk's CRC is " + hex(crc) + " and should be " +
                    hex(head.uncompressed_crc));
    }
    chunk.head.records = {};
    return {};
}

Result<CheckedRecords> check_records(ByteSpan records, Definitions& definitions) {
    CheckedRecords checked;
    for (std::size_t offset = 0; offset < records.size();) {
        const std::size_t begin = offset;
        const auto fault = [&](const std::string& cause) {
            return fail("at byte " + std::to_string(begin) +
                        " of the uncompressed chunk: " + cause);
        };
        const auto record = take_record(records, offset);
        if (!record) return fault("a record does not fit into the chunk");
        if (record->opcode == Opcode::schema || record->opcode == Opcode::channel) {
            if (auto ok = definitions.add(record->opcode, record->content, true); !ok) {
                checked.faults.push_back(ok.error().message);
            }
        } else if (record->opcode == Opcode::message) {
            MessageHead head;
            ByteSpan data;
            if (!parse(record->content, head, data)) return fault("a malformed Message record");
            if (definitions.channel(head.channel_id) == nullptr) {
                return fault("a message on channel " + std::to_string(head.channel_id) +
                             ", which the file does not define before");
            }
            checked.channels.insert(head.channel_id);
        }
    }
    return checked;
}

}  // namespace pursuit::recorder::mcap
