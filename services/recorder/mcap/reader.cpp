// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/reader.hpp"

#include <algorithm>
#include <array>

#include "services/recorder/mcap/compression.hpp"

namespace pursuit::recorder::mcap {
namespace {

constexpr std::size_t max_faults = 100;
constexpr std::size_t attachment_block_bytes = 64 << 10;

std::string bytes_text(std::uint64_t bytes) { return std::to_string(bytes) + " bytes"; }

}  // namespace

std::string_view name_of(Condition condition) {
    switch (condition) {
        case Condition::reading:
            return "not read to its end";
        case Condition::closed:
            return "closed cleanly";
        case Condition::not_closed:
            return "not closed";
        case Condition::cut:
            return "cut short";
        case Condition::damaged:
            return "damaged";
        case Condition::unreadable:
            return "unreadable";
    }
    return "";
}

std::string to_string(const Fault& fault, const std::string& file_name) {
    return file_name + ": byte " + std::to_string(fault.offset) + ": " + fault.cause;
}

Reader::Reader(std::unique_ptr<Input> input, std::uint64_t size, std::string file_name,
               ReadLimits limits, OnDamage on_damage)
    : input_(std::move(input)),
      in_(*input_, size),
      file_name_(std::move(file_name)),
      limits_(limits),
      on_damage_(on_damage),
      definitions_(limits.definition_bytes) {}

Result<Reader> Reader::open(std::unique_ptr<Input> input, std::string file_name, ReadLimits limits,
                            OnDamage on_damage) {
    const auto size = input->size();
    if (!size) return tl::unexpected(size.error());
    Reader reader(std::move(input), *size, std::move(file_name), limits, on_damage);
    reader.read_magic_and_header();
    if (reader.condition_ != Condition::reading) {
        return fail(to_string(reader.faults_.front(), reader.file_name_));
    }
    return reader;
}

Result<std::optional<MessageView>> Reader::next() {
    auto message = take_from_chunk();
    while (!message && condition_ == Condition::reading) {
        message = read_record();
        if (!message) message = take_from_chunk();
    }
    if (message) {
        ++totals_.messages;
        return message;
    }
    if (!faults_.empty()) return fail(to_string(faults_.front(), file_name_));
    return std::optional<MessageView>();
}

void Reader::read_magic_and_header() {
    std::array<std::uint8_t, magic.size()> found{};
    if (in_.remaining() == 0) return end(Condition::cut, "the file is empty");
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(in_.remaining(), found.size()));
    if (auto ok = in_.read(std::span(found).first(n)); !ok) {
        return end(Condition::unreadable, ok.error().message);
    }
    if (!std::equal(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(n), magic.begin())) {
        return end(Condition::damaged, "this is not an MCAP file: it does not begin as one");
    }
    if (n < found.size()) return end(Condition::cut, "the file ends within its first bytes");

    record_offset_ = in_.position();
    if (in_.remaining() < record_head_bytes) {
        return end(Condition::cut, "the file ends before its Header record");
    }
    std::array<std::uint8_t, record_head_bytes> head{};
    if (auto ok = in_.read(head); !ok) return end(Condition::unreadable, ok.error().message);
    ByteReader reader(head);
    const auto opcode = static_cast<Opcode>(reader.u8());
    if (opcode != Opcode::header) {
        return end(Condition::damaged, "a Header record belongs here, not " + name_of(opcode));
    }
    if (!load(reader.u64())) return;
    if (!parse(content_, header_)) end(Condition::damaged, "the Header record is malformed");
}

std::optional<MessageView> Reader::take_from_chunk() {
    while (chunk_offset_ < chunk_.records.size()) {
        const auto record = take_record(chunk_.records, chunk_offset_);
        if (!record || record->opcode != Opcode::message) continue;  // check_records() has checked.
        MessageView message;
        parse(record->content, message.head, message.data);
        message.channel = definitions_.channel(message.head.channel_id);
        return message;
    }
    return std::nullopt;
}

std::optional<MessageView> Reader::read_record() {
    record_offset_ = in_.position();
    if (in_.remaining() == 0) {
        end(Condition::not_closed,
            "the file ends here without having been closed; all before is good");
        return std::nullopt;
    }
    if (in_.remaining() < record_head_bytes) {
        end(Condition::cut,
            "the file ends within the first " + bytes_text(record_head_bytes) + " of a record");
        return std::nullopt;
    }
    crc_before_record_ = in_.crc();
    std::array<std::uint8_t, record_head_bytes> head{};
    if (auto ok = in_.read(head); !ok) {
        end(Condition::unreadable, ok.error().message);
        return std::nullopt;
    }
    ByteReader reader(head);
    const auto opcode = static_cast<Opcode>(reader.u8());
    const std::uint64_t size = reader.u64();
    if (static_cast<std::uint8_t>(opcode) == 0) {
        end(Condition::damaged, "a record with opcode 0, which does not exist");
        return std::nullopt;
    }
    if (size > in_.remaining()) {
        end(Condition::cut, "the file ends within a " + name_of(opcode) + " record of " +
                                bytes_text(size) + ", of which " + bytes_text(in_.remaining()) +
                                " are there");
        return std::nullopt;
    }

    const bool in_data = !summary_begin_.has_value();
    if (opcode == Opcode::footer) {
        if (size != footer_bytes) {
            end(Condition::damaged, "a Footer record of " + bytes_text(size));
        } else if (load(size)) {
            // The footer's CRC covers its own head and first two fields as well.
            auto crc = crc32(crc_before_record_, head);
            crc = crc32(crc, ByteSpan(content_).first(footer_bytes - 4));
            read_footer(crc);
        }
    } else if (in_data && opcode == Opcode::attachment) {
        read_attachment(size);
    } else if (in_data &&
               (opcode == Opcode::chunk || opcode == Opcode::schema || opcode == Opcode::channel ||
                opcode == Opcode::message || opcode == Opcode::metadata ||
                opcode == Opcode::data_end || opcode == Opcode::message_index)) {
        if (!load(size)) return std::nullopt;
        if (opcode == Opcode::chunk) read_chunk();
        if (opcode == Opcode::schema || opcode == Opcode::channel) read_definition(opcode);
        if (opcode == Opcode::message) return read_message();
        if (opcode == Opcode::metadata) read_metadata();
        if (opcode == Opcode::message_index) read_message_index();
        if (opcode == Opcode::data_end) read_data_end();
    } else if (auto ok = in_.skip(size); !ok) {
        end(Condition::unreadable, ok.error().message);
    }
    return std::nullopt;
}

bool Reader::load(std::uint64_t size) {
    if (size > in_.remaining()) {
        end(Condition::cut, "the file ends within a record of " + bytes_text(size));
        return false;
    }
    if (size > limits_.record_bytes) {
        end(Condition::damaged, "a record of " + bytes_text(size) + "; at most " +
                                    std::to_string(limits_.record_bytes) + " are read");
        return false;
    }
    content_.resize(static_cast<std::size_t>(size));
    if (auto ok = in_.read(content_); !ok) {
        end(Condition::unreadable, ok.error().message);
        return false;
    }
    return true;
}

void Reader::read_chunk() {
    chunk_offset_ = 0;
    not_indexed_.clear();
    auto ok = decode_chunk(content_, limits_, chunk_);
    if (ok) {
        auto checked = check_records(chunk_.records, definitions_);
        if (!checked) {
            ok = tl::unexpected(checked.error());
        } else if (!checked->faults.empty() && on_damage_ == OnDamage::stop) {
            ok = fail(checked->faults.front());
        } else {
            for (auto& fault : checked->faults) note(Condition::damaged, std::move(fault));
            not_indexed_ = std::move(checked->channels);
        }
    }
    chunk_damaged_ = !ok;
    if (!ok) {
        chunk_.records.clear();
        if (on_damage_ == OnDamage::stop) return end(Condition::damaged, ok.error().message);
        ++totals_.damaged_chunks;
        return note(Condition::damaged, ok.error().message);
    }
    ++totals_.chunks;
    totals_.compressed_bytes += chunk_.compressed_bytes;
    totals_.uncompressed_bytes += chunk_.records.size();
    place_ = ChunkPlace{record_offset_, in_.position() - record_offset_, chunk_.head.start_time_ns,
                        chunk_.head.end_time_ns};
}

void Reader::read_definition(Opcode opcode) {
    auto ok = definitions_.add(opcode, content_, false);
    if (ok) return;
    // The chunks repeat it.
    if (on_damage_ == OnDamage::skip_chunk) return note(Condition::damaged, ok.error().message);
    end(Condition::damaged, ok.error().message);
}

void Reader::read_metadata() {
    metadata_bytes_ += content_.size();
    Metadata metadata;
    if (!parse(content_, metadata)) {
        return end(Condition::damaged, "the Metadata record is malformed");
    }
    if (metadata_bytes_ > limits_.definition_bytes) {
        return end(Condition::damaged,
                   "metadata of more than " + bytes_text(limits_.definition_bytes) + " altogether");
    }
    metadata_.push_back(std::move(metadata));
}

void Reader::read_message_index() {
    // The index is not used, but where a flipped bit has made a Chunk record into one of another
    // kind, its index tells.
    ByteReader reader(content_);
    const auto channel_id = reader.u16();
    const auto bytes = reader.u32();
    const bool fits = reader.ok() && bytes <= reader.remaining();
    if (fits && (bytes == 0 || chunk_damaged_ || not_indexed_.erase(channel_id) == 1)) return;
    const std::string cause = fits ? "a MessageIndex record of channel " +
                                         std::to_string(channel_id) +
                                         ", which the chunk before it does not have"
                                   : "the MessageIndex record is malformed";
    if (on_damage_ == OnDamage::stop) return end(Condition::damaged, cause);
    note(Condition::damaged, cause);
}

std::optional<MessageView> Reader::read_message() {
    MessageView message;
    if (!not_indexed_.empty()) {
        // A flipped bit makes a MessageIndex record into a Message record, which no CRC covers.
        end(Condition::damaged, "a Message record where the index of a chunk belongs");
        return std::nullopt;
    }
    if (!parse(content_, message.head, message.data)) {
        end(Condition::damaged, "the Message record is malformed");
        return std::nullopt;
    }
    message.channel = definitions_.channel(message.head.channel_id);
    if (message.channel == nullptr) {
        end(Condition::damaged, "a message on channel " + std::to_string(message.head.channel_id) +
                                    ", which the file does not define before");
        return std::nullopt;
    }
    place_.reset();
    return message;
}

void Reader::read_attachment(std::uint64_t size) {
    // The last four bytes are the CRC of those before; the content is passed over.
    if (size < 4) return end(Condition::damaged, "the Attachment record is malformed");
    std::uint32_t crc = 0;
    content_.resize(attachment_block_bytes);
    for (std::uint64_t left = size - 4; left > 0;) {
        const auto n = std::min<std::uint64_t>(left, content_.size());
        const auto block = std::span(content_).first(static_cast<std::size_t>(n));
        if (auto ok = in_.read(block); !ok) return end(Condition::unreadable, ok.error().message);
        crc = crc32(crc, block);
        left -= n;
    }
    std::array<std::uint8_t, 4> stored_bytes{};
    if (auto ok = in_.read(stored_bytes); !ok) {
        return end(Condition::unreadable, ok.error().message);
    }
    const auto stored = ByteReader(stored_bytes).u32();
    if (stored == 0 || stored == crc) return;
    if (on_damage_ == OnDamage::stop) {
        return end(Condition::damaged, "the attachment's CRC is wrong");
    }
    note(Condition::damaged, "the attachment's CRC is wrong");
}

void Reader::read_data_end() {
    ByteReader reader(content_);
    const auto stored = reader.u32();
    if (!reader.ok()) return end(Condition::damaged, "the DataEnd record is malformed");
    summary_begin_ = in_.position();
    in_.restart_crc();
    if (stored == 0 || stored == crc_before_record_) return;
    const std::string cause = "the CRC of all data before this place is wrong";
    if (on_damage_ == OnDamage::stop) return end(Condition::damaged, cause);
    note(Condition::damaged, cause);
}

void Reader::read_footer(std::uint32_t crc) {
    Footer footer;
    parse(content_, footer);
    if (footer.summary_start != 0) {
        if (!summary_begin_ || footer.summary_start != *summary_begin_) {
            return end(Condition::damaged, "the Footer says that the summary begins at byte " +
                                               std::to_string(footer.summary_start) +
                                               ", which it does not");
        }
        if (footer.summary_crc != 0 && footer.summary_crc != crc) {
            return end(Condition::damaged, "the CRC of the summary is wrong");
        }
    }
    record_offset_ = in_.position();
    std::array<std::uint8_t, magic.size()> found{};
    if (in_.remaining() < found.size()) {
        return end(Condition::cut, "the file ends within its last bytes");
    }
    if (auto ok = in_.read(found); !ok) return end(Condition::unreadable, ok.error().message);
    if (found != magic) return end(Condition::damaged, "the file does not end as an MCAP file");
    if (in_.remaining() != 0) {
        record_offset_ = in_.position();
        return end(Condition::damaged, bytes_text(in_.remaining()) + " follow the file's end");
    }
    condition_ = faults_.empty() ? Condition::closed : Condition::damaged;
}

void Reader::end(Condition condition, std::string cause) {
    note(condition, std::move(cause));
    condition_ = condition;
}

void Reader::note(Condition condition, std::string cause) {
    if (faults_.size() < max_faults)
        faults_.push_back({condition, record_offset_, std::move(cause)});
}

}  // namespace pursuit::recorder::mcap
