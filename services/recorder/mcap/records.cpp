// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/records.hpp"

namespace pursuit::recorder::mcap {
namespace {

void append_map(ByteWriter& out, const StringMap& map) {
    const std::size_t begin = out.position();
    out.u32(0);
    for (const auto& [key, value] : map) {
        out.string(key);
        out.string(value);
    }
    out.u32_at(begin, static_cast<std::uint32_t>(out.position() - begin - 4));
}

void append_map(ByteWriter& out, const std::map<std::uint16_t, std::uint64_t>& map) {
    out.u32(static_cast<std::uint32_t>(map.size() * 10));
    for (const auto& [key, value] : map) {
        out.u16(key);
        out.u64(value);
    }
}

bool parse_map(ByteReader& in, StringMap& map) {
    ByteReader entries(in.bytes(in.u32()));
    while (entries.ok() && entries.remaining() > 0) {
        std::string key(entries.string());
        map.emplace(std::move(key), entries.string());
    }
    return entries.ok();
}

bool parse_map(ByteReader& in, std::map<std::uint16_t, std::uint64_t>& map) {
    ByteReader entries(in.bytes(in.u32()));
    while (entries.ok() && entries.remaining() > 0) {
        const auto key = entries.u16();
        map.emplace(key, entries.u64());
    }
    return entries.ok();
}

}  // namespace

std::string name_of(Opcode opcode) {
    switch (opcode) {
        case Opcode::header:
            return "Header";
        case Opcode::footer:
            return "Footer";
        case Opcode::schema:
            return "Schema";
        case Opcode::channel:
            return "Channel";
        case Opcode::message:
            return "Message";
        case Opcode::chunk:
            return "Chunk";
        case Opcode::message_index:
            return "MessageIndex";
        case Opcode::chunk_index:
            return "ChunkIndex";
        case Opcode::attachment:
            return "Attachment";
        case Opcode::attachment_index:
            return "AttachmentIndex";
        case Opcode::statistics:
            return "Statistics";
        case Opcode::metadata:
            return "Metadata";
        case Opcode::metadata_index:
            return "MetadataIndex";
        case Opcode::summary_offset:
            return "SummaryOffset";
        case Opcode::data_end:
            return "DataEnd";
    }
    constexpr std::string_view digits = "0123456789abcdef";
    const auto value = static_cast<std::uint8_t>(opcode);
    return std::string("record 0x") + digits[value >> 4] + digits[value & 15];
}

std::size_t begin_record(Bytes& out, Opcode opcode) {
    const std::size_t begin = out.size();
    ByteWriter writer(out);
    writer.u8(static_cast<std::uint8_t>(opcode));
    writer.u64(0);
    return begin;
}

void end_record(Bytes& out, std::size_t begin) {
    ByteWriter(out).u64_at(begin + 1, out.size() - begin - record_head_bytes);
}

void append(Bytes& out, const Header& header) {
    const auto begin = begin_record(out, Opcode::header);
    ByteWriter writer(out);
    writer.string(header.profile);
    writer.string(header.library);
    end_record(out, begin);
}

void append(Bytes& out, const Schema& schema) {
    const auto begin = begin_record(out, Opcode::schema);
    ByteWriter writer(out);
    writer.u16(schema.id);
    writer.string(schema.name);
    writer.string(schema.encoding);
    writer.string(schema.data);
    end_record(out, begin);
}

void append(Bytes& out, const Channel& channel) {
    const auto begin = begin_record(out, Opcode::channel);
    ByteWriter writer(out);
    writer.u16(channel.id);
    writer.u16(channel.schema_id);
    writer.string(channel.topic);
    writer.string(channel.message_encoding);
    append_map(writer, channel.metadata);
    end_record(out, begin);
}

void append(Bytes& out, const MessageHead& head, ByteSpan data) {
    const auto begin = begin_record(out, Opcode::message);
    ByteWriter writer(out);
    writer.u16(head.channel_id);
    writer.u32(head.sequence);
    writer.time(head.log_time_ns);
    writer.time(head.publish_time_ns);
    writer.bytes(data);
    end_record(out, begin);
}

void append(Bytes& out, const ChunkHead& chunk) {
    const auto begin = begin_record(out, Opcode::chunk);
    ByteWriter writer(out);
    writer.time(chunk.start_time_ns);
    writer.time(chunk.end_time_ns);
    writer.u64(chunk.uncompressed_bytes);
    writer.u32(chunk.uncompressed_crc);
    writer.string(chunk.compression);
    writer.u64(chunk.records.size());
    writer.bytes(chunk.records);
    end_record(out, begin);
}

void append(Bytes& out, const ChunkIndex& index) {
    const auto begin = begin_record(out, Opcode::chunk_index);
    ByteWriter writer(out);
    writer.time(index.start_time_ns);
    writer.time(index.end_time_ns);
    writer.u64(index.chunk_offset);
    writer.u64(index.chunk_bytes);
    append_map(writer, index.message_index_offsets);
    writer.u64(index.message_index_bytes);
    writer.string(index.compression);
    writer.u64(index.compressed_bytes);
    writer.u64(index.uncompressed_bytes);
    end_record(out, begin);
}

void append(Bytes& out, const Metadata& metadata) {
    const auto begin = begin_record(out, Opcode::metadata);
    ByteWriter writer(out);
    writer.string(metadata.name);
    append_map(writer, metadata.values);
    end_record(out, begin);
}

void append(Bytes& out, const MetadataIndex& index) {
    const auto begin = begin_record(out, Opcode::metadata_index);
    ByteWriter writer(out);
    writer.u64(index.offset);
    writer.u64(index.bytes);
    writer.string(index.name);
    end_record(out, begin);
}

void append(Bytes& out, const Statistics& statistics) {
    const auto begin = begin_record(out, Opcode::statistics);
    ByteWriter writer(out);
    writer.u64(statistics.messages);
    writer.u16(statistics.schemas);
    writer.u32(statistics.channels);
    writer.u32(statistics.attachments);
    writer.u32(statistics.metadata);
    writer.u32(statistics.chunks);
    writer.time(statistics.start_time_ns);
    writer.time(statistics.end_time_ns);
    append_map(writer, statistics.channel_messages);
    end_record(out, begin);
}

bool parse(ByteSpan content, Header& header) {
    ByteReader in(content);
    header.profile = in.string();
    header.library = in.string();
    return in.ok();
}

bool parse(ByteSpan content, Schema& schema) {
    ByteReader in(content);
    schema.id = in.u16();
    schema.name = in.string();
    schema.encoding = in.string();
    schema.data = in.string();
    return in.ok();
}

bool parse(ByteSpan content, Channel& channel) {
    ByteReader in(content);
    channel.id = in.u16();
    channel.schema_id = in.u16();
    channel.topic = in.string();
    channel.message_encoding = in.string();
    channel.metadata.clear();
    return parse_map(in, channel.metadata) && in.ok();
}

bool parse(ByteSpan content, MessageHead& head, ByteSpan& data) {
    ByteReader in(content);
    head.channel_id = in.u16();
    head.sequence = in.u32();
    head.log_time_ns = in.time();
    head.publish_time_ns = in.time();
    data = in.bytes(in.remaining());
    return in.ok();
}

bool parse(ByteSpan content, ChunkHead& chunk) {
    ByteReader in(content);
    chunk.start_time_ns = in.time();
    chunk.end_time_ns = in.time();
    chunk.uncompressed_bytes = in.u64();
    chunk.uncompressed_crc = in.u32();
    chunk.compression = in.string();
    chunk.records = in.bytes(in.u64());
    return in.ok();
}

bool parse(ByteSpan content, ChunkIndex& index) {
    ByteReader in(content);
    index.start_time_ns = in.time();
    index.end_time_ns = in.time();
    index.chunk_offset = in.u64();
    index.chunk_bytes = in.u64();
    index.message_index_offsets.clear();
    const bool map_ok = parse_map(in, index.message_index_offsets);
    index.message_index_bytes = in.u64();
    index.compression = in.string();
    index.compressed_bytes = in.u64();
    index.uncompressed_bytes = in.u64();
    return map_ok && in.ok();
}

bool parse(ByteSpan content, Metadata& metadata) {
    ByteReader in(content);
    metadata.name = in.string();
    metadata.values.clear();
    return parse_map(in, metadata.values) && in.ok();
}

bool parse(ByteSpan content, Statistics& statistics) {
    ByteReader in(content);
    statistics.messages = in.u64();
    statistics.schemas = in.u16();
    statistics.channels = in.u32();
    statistics.attachments = in.u32();
    statistics.metadata = in.u32();
    statistics.chunks = in.u32();
    statistics.start_time_ns = in.time();
    statistics.end_time_ns = in.time();
    statistics.channel_messages.clear();
    return parse_map(in, statistics.channel_messages) && in.ok();
}

bool parse(ByteSpan content, Footer& footer) {
    ByteReader in(content);
    footer.summary_start = in.u64();
    footer.summary_offset_start = in.u64();
    footer.summary_crc = in.u32();
    return in.ok();
}

std::optional<RecordView> take_record(ByteSpan records, std::size_t& offset) {
    ByteReader in(records.subspan(offset));
    RecordView view;
    view.opcode = static_cast<Opcode>(in.u8());
    view.content = in.bytes(in.u64());
    if (!in.ok()) return std::nullopt;
    offset += in.position();
    return view;
}

}  // namespace pursuit::recorder::mcap
