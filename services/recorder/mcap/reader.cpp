// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/reader.hpp"

#include "services/recorder/mcap/compression.hpp"

namespace pursuit::recorder::mcap {

Reader::Reader(std::unique_ptr<Input> input, std::uint64_t size, std::string file_name,
               ReadLimits limits, OnDamage on_damage)
    : input_(std::move(input)),
      records_(*input_, size, limits.record_bytes),
      file_name_(std::move(file_name)),
      limits_(limits),
      log_(on_damage),
      definitions_(limits.definition_bytes) {}

Result<Reader> Reader::open(std::unique_ptr<Input> input, std::string file_name, ReadLimits limits,
                            OnDamage on_damage) {
    const auto size = input->size();
    if (!size) return tl::unexpected(size.error());
    Reader reader(std::move(input), *size, std::move(file_name), limits, on_damage);
    reader.read_header();
    if (reader.condition() != Condition::reading) {
        return fail(to_string(reader.faults().front(), reader.file_name_));
    }
    return reader;
}

Result<std::optional<MessageView>> Reader::next() {
    auto message = chunk_.next(definitions_);
    while (!message && condition() == Condition::reading) {
        message = read_record();
        if (!message) message = chunk_.next(definitions_);
    }
    if (message) {
        ++totals_.messages;
        return message;
    }
    if (!faults().empty()) return fail(to_string(faults().front(), file_name_));
    return std::optional<MessageView>();
}

void Reader::read_header() {
    const auto content = records_.read_header();
    if (!content) return log_.end(content.error());
    if (!parse(*content, header_)) end("the Header record is malformed");
}

std::optional<MessageView> Reader::read_record() {
    const auto head = records_.read_head();
    if (!head) {
        log_.end(head.error());
        return std::nullopt;
    }
    const auto opcode = head->opcode;
    const bool in_data = !summary_begin_.has_value();
    if (opcode == Opcode::footer) {
        read_footer(*head);
    } else if (in_data && opcode == Opcode::attachment) {
        read_attachment(head->size);
    } else if (in_data &&
               (opcode == Opcode::chunk || opcode == Opcode::schema || opcode == Opcode::channel ||
                opcode == Opcode::message || opcode == Opcode::metadata ||
                opcode == Opcode::data_end || opcode == Opcode::message_index)) {
        const auto content = records_.read_content(head->size);
        if (!content) {
            log_.end(content.error());
            return std::nullopt;
        }
        if (opcode == Opcode::chunk) read_chunk(*content);
        if (opcode == Opcode::schema || opcode == Opcode::channel) {
            read_definition(opcode, *content);
        }
        if (opcode == Opcode::message) return read_message(*content);
        if (opcode == Opcode::metadata) read_metadata(*content);
        if (opcode == Opcode::message_index) read_message_index(*content);
        if (opcode == Opcode::data_end) read_data_end(*content, head->crc_before);
    } else if (auto ok = records_.skip(head->size); !ok) {
        log_.end(ok.error());
    }
    return std::nullopt;
}

void Reader::read_chunk(ByteSpan content) {
    auto faults = chunk_.load(content, limits_, definitions_);
    if (faults && !faults->empty() && log_.on_damage() == OnDamage::stop) {
        chunk_.discard();
        return end(faults->front());
    }
    if (!faults) {
        if (log_.on_damage() == OnDamage::skip_chunk) ++totals_.damaged_chunks;
        return damage(faults.error().message);
    }
    for (auto& fault : *faults) damage(std::move(fault));
    const auto& chunk = chunk_.chunk();
    ++totals_.chunks;
    totals_.compressed_bytes += chunk.compressed_bytes;
    totals_.uncompressed_bytes += chunk.records.size();
    place_ = ChunkPlace{records_.offset(), records_.position() - records_.offset(),
                        chunk.head.start_time_ns, chunk.head.end_time_ns};
}

void Reader::read_definition(Opcode opcode, ByteSpan content) {
    // A damaged one may be left out: the chunks repeat it.
    if (auto ok = definitions_.add(opcode, content, false); !ok) damage(ok.error().message);
}

void Reader::read_metadata(ByteSpan content) {
    metadata_bytes_ += content.size();
    Metadata metadata;
    if (!parse(content, metadata)) return end("the Metadata record is malformed");
    if (metadata_bytes_ > limits_.definition_bytes) {
        return end("metadata of more than " + std::to_string(limits_.definition_bytes) +
                   " bytes altogether");
    }
    metadata_.push_back(std::move(metadata));
}

void Reader::read_message_index(ByteSpan content) {
    // The index is not used, but where a flipped bit has made a Chunk record into one of another
    // kind, its index tells.
    ByteReader reader(content);
    const auto channel_id = reader.u16();
    const auto bytes = reader.u32();
    if (!reader.ok() || bytes > reader.remaining()) {
        return damage("the MessageIndex record is malformed");
    }
    if (!chunk_.take_index(channel_id, bytes)) {
        damage("a MessageIndex record of channel " + std::to_string(channel_id) +
               ", which the chunk before it does not have");
    }
}

std::optional<MessageView> Reader::read_message(ByteSpan content) {
    MessageView message;
    if (chunk_.awaits_index()) {
        // A flipped bit makes a MessageIndex record into a Message record, which no CRC covers.
        end("a Message record where the index of a chunk belongs");
        return std::nullopt;
    }
    if (!parse(content, message.head, message.data)) {
        end("the Message record is malformed");
        return std::nullopt;
    }
    message.channel = definitions_.channel(message.head.channel_id);
    if (message.channel == nullptr) {
        end("a message on channel " + std::to_string(message.head.channel_id) +
            ", which the file does not define before");
        return std::nullopt;
    }
    place_.reset();
    return message;
}

void Reader::read_attachment(std::uint64_t size) {
    if (size < 4) return end("the Attachment record is malformed");
    const auto right = records_.check_trailing_crc(size);
    if (!right) return log_.end(right.error());
    if (!*right) damage("the attachment's CRC is wrong");
}

void Reader::read_data_end(ByteSpan content, std::uint32_t crc) {
    ByteReader reader(content);
    const auto stored = reader.u32();
    if (!reader.ok()) return end("the DataEnd record is malformed");
    summary_begin_ = records_.position();
    records_.restart_crc();
    if (stored != 0 && stored != crc) damage("the CRC of all data before this place is wrong");
}

void Reader::read_footer(const RecordHead& head) {
    if (head.size != footer_bytes) {
        return end("a Footer record of " + std::to_string(head.size) + " bytes");
    }
    const auto content = records_.read_content(head.size);
    if (!content) return log_.end(content.error());
    // The footer's CRC covers its own head and first two fields as well.
    auto crc = crc32(head.crc_before, head.bytes);
    crc = crc32(crc, content->first(footer_bytes - 4));
    Footer footer;
    parse(*content, footer);
    if (footer.summary_start != 0) {
        if (!summary_begin_ || footer.summary_start != *summary_begin_) {
            return end("the Footer says that the summary begins at byte " +
                       std::to_string(footer.summary_start) + ", which it does not");
        }
        if (footer.summary_crc != 0 && footer.summary_crc != crc) {
            return end("the CRC of the summary is wrong");
        }
    }
    if (auto ok = records_.read_end(); !ok) return log_.end(ok.error());
    log_.close();
}

/// Damage behind which nothing can be read.
void Reader::end(std::string cause) {
    log_.end({Condition::damaged, records_.offset(), std::move(cause)});
}

/// Damage that may be passed over.
void Reader::damage(std::string cause) { log_.damage(records_.offset(), std::move(cause)); }

}  // namespace pursuit::recorder::mcap
