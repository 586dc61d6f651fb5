// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "services/recorder/mcap/bytes.hpp"

/// The records of an MCAP file (MCAP Format Specification, major version 0), as plain structs with
/// one function to append each and one to parse it. A file is
///   magic Header {data records} DataEnd {summary records} {SummaryOffset} Footer magic
/// and every record is one octet of opcode, 8 octets of content length, the content.
namespace pursuit::recorder::mcap {

inline constexpr std::array<std::uint8_t, 8> magic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr std::size_t record_head_bytes = 9;

enum class Opcode : std::uint8_t {
    header = 0x01,
    footer = 0x02,
    schema = 0x03,
    channel = 0x04,
    message = 0x05,
    chunk = 0x06,
    message_index = 0x07,
    chunk_index = 0x08,
    attachment = 0x09,
    attachment_index = 0x0A,
    statistics = 0x0B,
    metadata = 0x0C,
    metadata_index = 0x0D,
    summary_offset = 0x0E,
    data_end = 0x0F,
};

/// "Chunk", or "record 0x4f" for an opcode that this version does not know.
std::string name_of(Opcode opcode);

using StringMap = std::map<std::string, std::string>;

struct Header {
    std::string profile;
    std::string library;
};

struct Schema {
    std::uint16_t id = 0;  ///< From 1.
    std::string name;      ///< As "pursuit::v1::EventPacket".
    std::string encoding;  ///< As "omgidl".
    std::string data;

    friend bool operator==(const Schema&, const Schema&) = default;
};

struct Channel {
    std::uint16_t id = 0;
    std::uint16_t schema_id = 0;  ///< 0: none.
    std::string topic;
    std::string message_encoding;  ///< As "cdr".
    StringMap metadata;

    friend bool operator==(const Channel&, const Channel&) = default;
};

/// The fields of a message before its data. Times are ns since 1970.
struct MessageHead {
    std::uint16_t channel_id = 0;
    std::uint32_t sequence = 0;
    std::int64_t log_time_ns = 0;
    std::int64_t publish_time_ns = 0;
};

/// A Chunk record's fields; `records` stays in the buffer it was parsed from.
struct ChunkHead {
    std::int64_t start_time_ns = 0;  ///< Earliest log time in it; 0 without messages.
    std::int64_t end_time_ns = 0;
    std::uint64_t uncompressed_bytes = 0;
    std::uint32_t uncompressed_crc = 0;  ///< 0: not to be checked.
    std::string compression;             ///< "", "zstd" or "lz4".
    ByteSpan records;
};

struct ChunkIndex {
    std::int64_t start_time_ns = 0;
    std::int64_t end_time_ns = 0;
    std::uint64_t chunk_offset = 0;
    std::uint64_t chunk_bytes = 0;  ///< Of the whole record.
    std::map<std::uint16_t, std::uint64_t> message_index_offsets;
    std::uint64_t message_index_bytes = 0;
    std::string compression;
    std::uint64_t compressed_bytes = 0;
    std::uint64_t uncompressed_bytes = 0;
};

struct Metadata {
    std::string name;
    StringMap values;
};

struct MetadataIndex {
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
    std::string name;
};

struct Statistics {
    std::uint64_t messages = 0;
    std::uint16_t schemas = 0;
    std::uint32_t channels = 0;
    std::uint32_t attachments = 0;
    std::uint32_t metadata = 0;
    std::uint32_t chunks = 0;
    std::int64_t start_time_ns = 0;
    std::int64_t end_time_ns = 0;
    std::map<std::uint16_t, std::uint64_t> channel_messages;
};

struct Footer {
    std::uint64_t summary_start = 0;
    std::uint64_t summary_offset_start = 0;
    std::uint32_t summary_crc = 0;
};
inline constexpr std::size_t footer_bytes = 20;  ///< Content; the record has 9 more.

/// Opens a record; `end_record` fills in its length.
std::size_t begin_record(Bytes& out, Opcode opcode);
void end_record(Bytes& out, std::size_t begin);

void append(Bytes& out, const Header& header);
void append(Bytes& out, const Schema& schema);
void append(Bytes& out, const Channel& channel);
void append(Bytes& out, const MessageHead& head, ByteSpan data);
void append(Bytes& out, const ChunkHead& chunk);
void append(Bytes& out, const ChunkIndex& index);
void append(Bytes& out, const Metadata& metadata);
void append(Bytes& out, const MetadataIndex& index);
void append(Bytes& out, const Statistics& statistics);

/// Parse the content of a record. False: it does not hold what its opcode promises. Fields added
/// at the end by later versions of the format are ignored.
bool parse(ByteSpan content, Header& header);
bool parse(ByteSpan content, Schema& schema);
bool parse(ByteSpan content, Channel& channel);
bool parse(ByteSpan content, MessageHead& head, ByteSpan& data);
bool parse(ByteSpan content, ChunkHead& chunk);
bool parse(ByteSpan content, ChunkIndex& index);
bool parse(ByteSpan content, Metadata& metadata);
bool parse(ByteSpan content, Statistics& statistics);
bool parse(ByteSpan content, Footer& footer);

/// One record inside a buffer of records, as a chunk holds them.
struct RecordView {
    Opcode opcode = Opcode::header;
    ByteSpan content;
};

/// Takes the record at `offset` and moves `offset` past it; nothing where it does not fit.
std::optional<RecordView> take_record(ByteSpan records, std::size_t& offset);

}  // namespace pursuit::recorder::mcap
