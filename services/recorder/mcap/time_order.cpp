// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/time_order.hpp"

#include <algorithm>
#include <tuple>

#include "services/recorder/mcap/summary.hpp"

namespace pursuit::recorder::mcap {
namespace {

/// Lends an input to a Reader, which owns what it reads from.
class BorrowedInput final : public Input {
 public:
    explicit BorrowedInput(Input& input) : input_(input) {}
    Result<std::uint64_t> size() override { return input_.size(); }
    Result<std::size_t> read_at(std::uint64_t offset, std::span<std::uint8_t> into) override {
        return input_.read_at(offset, into);
    }

 private:
    Input& input_;
};

/// Whether every message of the file is in a chunk that the summary knows.
bool complete(const Summary& summary) {
    return summary.statistics && summary.statistics->chunks == summary.chunks.size() &&
           (summary.statistics->messages == 0 || !summary.chunks.empty());
}

}  // namespace

TimeOrderedReader::TimeOrderedReader(std::unique_ptr<Input> input, std::string file_name,
                                     ReadLimits limits)
    : input_(std::move(input)),
      file_name_(std::move(file_name)),
      limits_(limits),
      definitions_(limits.definition_bytes) {}

Result<TimeOrderedReader> TimeOrderedReader::open(std::unique_ptr<Input> input,
                                                  std::string file_name, ReadLimits limits) {
    TimeOrderedReader reader(std::move(input), std::move(file_name), limits);
    if (auto ok = reader.find_chunks(); !ok) return tl::unexpected(ok.error());
    std::sort(reader.places_.begin(), reader.places_.end(), [](const auto& a, const auto& b) {
        return std::tie(a.start_time_ns, a.offset) < std::tie(b.start_time_ns, b.offset);
    });
    return reader;
}

Result<void> TimeOrderedReader::find_chunks() {
    if (auto summary = read_summary(*input_, limits_); summary && complete(*summary)) {
        for (const auto& chunk : summary->chunks) {
            places_.push_back(
                {chunk.chunk_offset, chunk.chunk_bytes, chunk.start_time_ns, chunk.end_time_ns});
        }
        definitions_ = std::move(summary->definitions);
        return {};
    }
    auto reader = Reader::open(std::make_unique<BorrowedInput>(*input_), file_name_, limits_);
    if (!reader) return tl::unexpected(reader.error());
    for (;;) {
        const auto message = reader->next();
        if (!message) {
            fault_ = message.error();
            break;
        }
        if (!*message) break;
        const auto& place = reader->chunk();
        if (!place) return fail(file_name_ + ": has messages outside chunks, cannot be sorted");
        if (places_.empty() || places_.back().offset != place->offset) places_.push_back(*place);
    }
    definitions_ = reader->definitions();
    return {};
}

Result<void> TimeOrderedReader::open_chunk(const ChunkPlace& place) {
    const auto fault = [&](std::string cause) {
        return fail(to_string({Condition::damaged, place.offset, std::move(cause)}, file_name_));
    };
    if (place.bytes < record_head_bytes || place.bytes > limits_.record_bytes) {
        return fault("a chunk of " + std::to_string(place.bytes) + " bytes");
    }
    Bytes record(static_cast<std::size_t>(place.bytes));
    const auto n = input_->read_at(place.offset, record);
    if (!n) return tl::unexpected(n.error());
    std::size_t end = 0;
    const auto view = take_record(ByteSpan(record).first(*n), end);
    if (!view || view->opcode != Opcode::chunk) {
        return fault("no Chunk record, though the chunk index says so");
    }
    Chunk chunk;
    if (auto ok = decode_chunk(view->content, limits_, chunk); !ok) {
        return fault(ok.error().message);
    }
    const auto checked = check_records(chunk.records, definitions_);
    if (!checked) return fault(checked.error().message);
    if (!checked->faults.empty()) return fault(checked->faults.front());
    open_bytes_ += chunk.records.size();
    if (open_bytes_ > limits_.open_chunk_bytes) {
        return fault("more than " + std::to_string(limits_.open_chunk_bytes) +
                     " bytes of chunks overlap in time");
    }

    OpenChunk open;
    open.file_offset = place.offset;
    for (std::size_t offset = 0; offset < chunk.records.size();) {
        const std::size_t begin = offset;
        const auto each = take_record(chunk.records, offset);
        if (each->opcode != Opcode::message) continue;
        MessageHead head;
        ByteSpan data;
        parse(each->content, head, data);
        if (head.log_time_ns < place.start_time_ns) {
            return fault("a message of the chunk is earlier than the chunk says");
        }
        open.entries.push_back({head.log_time_ns, begin});
    }
    if (open.entries.empty()) {
        open_bytes_ -= chunk.records.size();
        return {};
    }
    std::stable_sort(open.entries.begin(), open.entries.end(),
                     [](const Entry& a, const Entry& b) { return a.time_ns < b.time_ns; });
    open.records = std::move(chunk.records);
    open_.push_back(std::move(open));
    return {};
}

std::list<TimeOrderedReader::OpenChunk>::iterator TimeOrderedReader::earliest() {
    return std::min_element(open_.begin(), open_.end(), [](const auto& a, const auto& b) {
        return std::tie(a.entries[a.next].time_ns, a.file_offset) <
               std::tie(b.entries[b.next].time_ns, b.file_offset);
    });
}

Result<std::optional<MessageView>> TimeOrderedReader::next() {
    // The chunk of the last message is kept until now, because its data was lent.
    for (auto chunk = open_.begin(); chunk != open_.end();) {
        if (chunk->next < chunk->entries.size()) {
            ++chunk;
        } else {
            open_bytes_ -= chunk->records.size();
            chunk = open_.erase(chunk);
        }
    }
    auto first = earliest();
    while (next_place_ < places_.size() &&
           (first == open_.end() ||
            places_[next_place_].start_time_ns <= first->entries[first->next].time_ns)) {
        if (auto ok = open_chunk(places_[next_place_]); !ok) {
            // Nothing later may be given: it could come before what this chunk holds.
            fault_ = ok.error();
            next_place_ = places_.size();
            open_.clear();
            return tl::unexpected(*fault_);
        }
        ++next_place_;
        first = earliest();
    }
    if (first == open_.end()) {
        if (fault_) return tl::unexpected(*fault_);
        return std::optional<MessageView>();
    }

    std::size_t offset = first->entries[first->next++].offset;
    MessageView message;
    parse(take_record(first->records, offset)->content, message.head, message.data);
    message.channel = definitions_.channel(message.head.channel_id);
    return message;
}

}  // namespace pursuit::recorder::mcap
