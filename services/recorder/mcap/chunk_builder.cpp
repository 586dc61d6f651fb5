// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/chunk_builder.hpp"

#include <algorithm>

namespace pursuit::recorder::mcap {

void ChunkBuilder::add(const MessageHead& head, ByteSpan data) {
    start_time_ns_ = index_.empty() ? head.log_time_ns : std::min(start_time_ns_, head.log_time_ns);
    end_time_ns_ = index_.empty() ? head.log_time_ns : std::max(end_time_ns_, head.log_time_ns);
    index_[head.channel_id].emplace_back(head.log_time_ns, records_.size());
    append(records_, head, data);
}

Result<ChunkIndex> ChunkBuilder::finish(ZstdCompressor* compressor, std::uint64_t file_offset,
                                        Bytes& out) {
    ChunkHead chunk;
    chunk.start_time_ns = start_time_ns_;
    chunk.end_time_ns = end_time_ns_;
    chunk.uncompressed_bytes = records_.size();
    chunk.uncompressed_crc = crc32(0, records_);
    chunk.records = records_;
    if (compressor != nullptr) {
        if (auto ok = compressor->compress(records_, compressed_); !ok) {
            return tl::unexpected(ok.error());
        }
        chunk.compression = name_of(Compression::zstd);
        chunk.records = compressed_;
    }

    const std::size_t begin = out.size();
    append(out, chunk);
    ChunkIndex index;
    index.start_time_ns = chunk.start_time_ns;
    index.end_time_ns = chunk.end_time_ns;
    index.chunk_offset = file_offset;
    index.chunk_bytes = out.size() - begin;
    index.compression = chunk.compression;
    index.compressed_bytes = chunk.records.size();
    index.uncompressed_bytes = chunk.uncompressed_bytes;
    for (const auto& [channel_id, entries] : index_) {
        index.message_index_offsets[channel_id] = file_offset + (out.size() - begin);
        const auto record = begin_record(out, Opcode::message_index);
        ByteWriter writer(out);
        writer.u16(channel_id);
        writer.u32(static_cast<std::uint32_t>(entries.size() * 16));
        for (const auto& [time_ns, offset] : entries) {
            writer.time(time_ns);
            writer.u64(offset);
        }
        end_record(out, record);
    }
    index.message_index_bytes = out.size() - begin - index.chunk_bytes;

    records_.clear();
    index_.clear();
    start_time_ns_ = 0;
    end_time_ns_ = 0;
    return index;
}

}  // namespace pursuit::recorder::mcap
