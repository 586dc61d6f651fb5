// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/writer.hpp"

#include <algorithm>

namespace pursuit::recorder::mcap {
namespace {

constexpr std::size_t max_ids = 65535;

/// One SummaryOffset record, for a group of summary records.
struct Group {
    Opcode opcode;
    std::size_t begin;
    std::size_t end;
};

}  // namespace

Writer::Writer(std::unique_ptr<Output> output, WriterOptions options, std::int64_t now_us)
    : output_(std::move(output)), options_(std::move(options)), now_us_(now_us) {
    if (options_.compression == Compression::zstd) compressor_.emplace(options_.zstd_level);
}

Result<Writer> Writer::create(std::unique_ptr<Output> output, WriterOptions options,
                              std::int64_t now_us) {
    Writer writer(std::move(output), std::move(options), now_us);
    Bytes begin(magic.begin(), magic.end());
    append(begin, Header{writer.options_.profile, writer.options_.library});
    if (auto ok = writer.put(begin); !ok) return tl::unexpected(ok.error());
    return writer;
}

Result<std::uint16_t> Writer::add_schema(std::string_view name, std::string_view encoding,
                                         std::string_view data) {
    if (auto ok = usable(); !ok) return tl::unexpected(ok.error());
    Schema schema{0, std::string(name), std::string(encoding), std::string(data)};
    for (const auto& known : schemas_) {
        schema.id = known.id;
        if (schema == known) return known.id;
    }
    if (schemas_.size() == max_ids) return fail("schema " + schema.name + ": the file is full");
    schema.id = static_cast<std::uint16_t>(schemas_.size() + 1);
    Bytes record;
    append(record, schema);
    if (auto ok = define(record, "schema " + schema.name); !ok) return tl::unexpected(ok.error());
    chunk_.add(schema);
    schemas_.push_back(std::move(schema));
    return schemas_.back().id;
}

Result<std::uint16_t> Writer::add_channel(std::uint16_t schema_id, std::string_view topic,
                                          std::string_view message_encoding,
                                          const StringMap& metadata) {
    if (auto ok = usable(); !ok) return tl::unexpected(ok.error());
    Channel channel{0, schema_id, std::string(topic), std::string(message_encoding), metadata};
    if (schema_id > schemas_.size()) {
        return fail("channel " + channel.topic + ": there is no schema " +
                    std::to_string(schema_id));
    }
    for (const auto& known : channels_) {
        channel.id = known.id;
        if (channel == known) return known.id;
    }
    if (channels_.size() == max_ids) return fail("channel " + channel.topic + ": the file is full");
    channel.id = static_cast<std::uint16_t>(channels_.size() + 1);
    Bytes record;
    append(record, channel);
    if (auto ok = define(record, "channel " + channel.topic); !ok)
        return tl::unexpected(ok.error());
    chunk_.add(channel);
    channels_.push_back(std::move(channel));
    totals_.channel_messages[channels_.back().id] = 0;
    return channels_.back().id;
}

Result<void> Writer::add_metadata(const Metadata& metadata) {
    if (auto ok = usable(); !ok) return ok;
    Bytes record;
    append(record, metadata);
    const MetadataIndex index{totals_.bytes, record.size(), metadata.name};
    if (auto ok = define(record, "metadata " + metadata.name); !ok)
        return tl::unexpected(ok.error());
    append(metadata_indexes_, index);
    ++totals_.metadata;
    return {};
}

Result<void> Writer::write(const MessageHead& head, ByteSpan data) {
    if (auto ok = usable(); !ok) return ok;
    if (head.channel_id == 0 || head.channel_id > channels_.size()) {
        return fail("a message on channel " + std::to_string(head.channel_id) +
                    ", which was not added");
    }
    const auto& topic = channels_[head.channel_id - 1U].topic;
    if (head.log_time_ns < 0) {
        return fail("a message on " + topic + " with log time " + std::to_string(head.log_time_ns) +
                    " ns, before 1970");
    }
    if (data.size() > options_.max_message_bytes) {
        return fail("a message on " + topic + " of " + std::to_string(data.size()) +
                    " bytes; at most " + std::to_string(options_.max_message_bytes) +
                    " are recorded");
    }
    MessageHead written = head;
    if (written.publish_time_ns < 0) written.publish_time_ns = written.log_time_ns;
    if (chunk_.empty()) chunk_opened_us_ = now_us_;
    chunk_.add(written, data);

    const auto time_ns = written.log_time_ns;
    totals_.start_time_ns =
        totals_.messages == 0 ? time_ns : std::min(totals_.start_time_ns, time_ns);
    totals_.end_time_ns = std::max(totals_.end_time_ns, time_ns);
    ++totals_.messages;
    totals_.message_bytes += data.size();
    ++totals_.channel_messages[head.channel_id];
    totals_.open_chunk_bytes = chunk_.size();
    if (chunk_.size() >= options_.chunk_bytes) return close_chunk();
    return {};
}

Result<void> Writer::tick(std::int64_t now_us) {
    if (auto ok = usable(); !ok) return ok;
    now_us_ = std::max(now_us_, now_us);
    if (!chunk_.empty() && now_us_ - chunk_opened_us_ >= options_.chunk_age_us) {
        if (auto ok = close_chunk(); !ok) return ok;
    }
    if (totals_.flushed_bytes < totals_.bytes &&
        now_us_ - unflushed_since_us_ >= options_.flush_interval_us) {
        return flush_output();
    }
    return {};
}

Result<void> Writer::flush() {
    if (auto ok = usable(); !ok) return ok;
    if (auto ok = close_chunk(); !ok) return ok;
    return flush_output();
}

Result<void> Writer::close() {
    if (auto ok = usable(); !ok) return ok;
    if (auto ok = close_chunk(); !ok) return ok;
    Bytes end;
    const auto data_end = begin_record(end, Opcode::data_end);
    ByteWriter(end).u32(data_crc_);
    end_record(end, data_end);
    append_summary(end, totals_.bytes);
    end.insert(end.end(), magic.begin(), magic.end());
    if (auto ok = put(end); !ok) return ok;
    if (auto ok = flush_output(); !ok) return ok;
    closed_ = true;
    return {};
}

Result<void> Writer::usable() const {
    if (failure_) return tl::unexpected(*failure_);
    if (closed_) return fail("the recording is closed");
    return {};
}

Result<void> Writer::put(ByteSpan data) {
    if (totals_.flushed_bytes == totals_.bytes) unflushed_since_us_ = now_us_;
    if (auto ok = output_->write(data); !ok) {
        failure_ = ok.error();
        return ok;
    }
    totals_.bytes += data.size();
    data_crc_ = crc32(data_crc_, data);
    return {};
}

Result<void> Writer::flush_output() {
    if (auto ok = output_->flush(); !ok) {
        failure_ = ok.error();
        return ok;
    }
    totals_.flushed_bytes = totals_.bytes;
    return {};
}

Result<void> Writer::close_chunk() {
    if (chunk_.empty()) return {};
    scratch_.clear();
    auto index = chunk_.finish(compressor_ ? &*compressor_ : nullptr, totals_.bytes, scratch_);
    if (!index) {
        failure_ = index.error();
        return tl::unexpected(index.error());
    }
    if (auto ok = put(scratch_); !ok) return ok;
    ++totals_.chunks;
    totals_.open_chunk_bytes = 0;
    if (!index_full_) append(chunk_indexes_, *index);
    if (chunk_indexes_.size() > options_.max_index_bytes) {
        // The format wants the index of every chunk or none.
        index_full_ = true;
        Bytes().swap(chunk_indexes_);
    }
    if (options_.flush_interval_us == 0) return flush_output();
    return {};
}

Result<void> Writer::define(const Bytes& record, const std::string& what) {
    if (definition_bytes_ + record.size() > options_.max_definition_bytes) {
        return fail(what + ": definitions are bounded to " +
                    std::to_string(options_.max_definition_bytes) + " bytes a file");
    }
    if (auto ok = put(record); !ok) return ok;
    definition_bytes_ += record.size();
    if (chunk_.empty()) chunk_opened_us_ = now_us_;
    return {};
}

void Writer::append_summary(Bytes& out, std::uint64_t file_offset) const {
    const std::size_t begin = out.size();
    std::vector<Group> groups;
    const auto group = [&](Opcode opcode, const auto& write) {
        const std::size_t group_begin = out.size();
        write();
        if (out.size() > group_begin) groups.push_back({opcode, group_begin, out.size()});
    };
    group(Opcode::schema, [&] {
        for (const auto& schema : schemas_) append(out, schema);
    });
    group(Opcode::channel, [&] {
        for (const auto& channel : channels_) append(out, channel);
    });
    group(Opcode::statistics, [&] {
        Statistics statistics;
        statistics.messages = totals_.messages;
        statistics.schemas = static_cast<std::uint16_t>(schemas_.size());
        statistics.channels = static_cast<std::uint32_t>(channels_.size());
        statistics.metadata = totals_.metadata;
        statistics.chunks = static_cast<std::uint32_t>(totals_.chunks);
        statistics.start_time_ns = totals_.start_time_ns;
        statistics.end_time_ns = totals_.end_time_ns;
        statistics.channel_messages = totals_.channel_messages;
        append(out, statistics);
    });
    group(Opcode::chunk_index, [&] { ByteWriter(out).bytes(chunk_indexes_); });
    group(Opcode::metadata_index, [&] { ByteWriter(out).bytes(metadata_indexes_); });

    const std::size_t offsets_begin = out.size();
    for (const auto& each : groups) {
        const auto record = begin_record(out, Opcode::summary_offset);
        ByteWriter writer(out);
        writer.u8(static_cast<std::uint8_t>(each.opcode));
        writer.u64(file_offset + each.begin);
        writer.u64(each.end - each.begin);
        end_record(out, record);
    }

    // The CRC covers the summary and the footer up to the CRC itself, the footer's length included.
    ByteWriter writer(out);
    writer.u8(static_cast<std::uint8_t>(Opcode::footer));
    writer.u64(footer_bytes);
    writer.u64(file_offset + begin);
    writer.u64(file_offset + offsets_begin);
    writer.u32(crc32(0, ByteSpan(out).subspan(begin)));
}

}  // namespace pursuit::recorder::mcap
