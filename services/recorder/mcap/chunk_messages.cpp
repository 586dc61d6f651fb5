// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/chunk_messages.hpp"

#include <utility>

namespace pursuit::recorder::mcap {

Result<std::vector<std::string>> ChunkMessages::load(ByteSpan content, const ReadLimits& limits,
                                                     Definitions& definitions) {
    offset_ = 0;
    not_indexed_.clear();
    damaged_ = false;
    if (auto ok = decode_chunk(content, limits, chunk_); !ok) {
        discard();
        return tl::unexpected(ok.error());
    }
    auto checked = check_records(chunk_.records, definitions);
    if (!checked) {
        discard();
        return tl::unexpected(checked.error());
    }
    not_indexed_ = std::move(checked->channels);
    return std::move(checked->faults);
}

void ChunkMessages::discard() {
    chunk_.records.clear();
    not_indexed_.clear();
    damaged_ = true;
}

std::optional<MessageView> ChunkMessages::next(const Definitions& definitions) {
    while (offset_ < chunk_.records.size()) {
        const auto record = take_record(chunk_.records, offset_);
        if (!record || record->opcode != Opcode::message) continue;  // check_records() has checked.
        MessageView message;
        parse(record->content, message.head, message.data);
        message.channel = definitions.channel(message.head.channel_id);
        return message;
    }
    return std::nullopt;
}

bool ChunkMessages::take_index(std::uint16_t channel_id, std::uint32_t bytes) {
    return bytes == 0 || damaged_ || not_indexed_.erase(channel_id) == 1;
}

}  // namespace pursuit::recorder::mcap
