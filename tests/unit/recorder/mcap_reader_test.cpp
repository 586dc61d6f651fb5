// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/reader.hpp"

#include <gmock/gmock.h>

#include "services/recorder/mcap/compression.hpp"
#include "tests/unit/recorder/mcap_sample.hpp"

namespace pursuit::recorder::mcap {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Builds files by hand, as another writer might.
class Builder {
 public:
    Builder() : file_(magic.begin(), magic.end()) { append(file_, Header{"", "test"}); }

    Builder& schema(std::uint16_t id) { return append_record(Schema{id, "T", "omgidl", "text"}); }
    Builder& channel(std::uint16_t id, std::uint16_t schema_id,
                     const std::string& topic = "topic") {
        return append_record(Channel{id, schema_id, topic, "cdr", {}});
    }
    Builder& message(std::uint16_t channel, const std::string& data) {
        append(file_, MessageHead{channel, 1, 2, 3}, as_bytes(data));
        return *this;
    }
    Builder& record(Opcode opcode, ByteSpan content) {
        const auto begin = begin_record(file_, opcode);
        ByteWriter(file_).bytes(content);
        end_record(file_, begin);
        return *this;
    }
    Builder& record(Opcode opcode, const std::string& content) {
        return record(opcode, as_bytes(content));
    }
    Builder& chunk(const ChunkHead& chunk) { return append_record(chunk); }
    Builder& data_end() {
        Bytes content;
        ByteWriter(content).u32(crc32(0, file_));
        return record(Opcode::data_end, content);
    }
    Builder& footer() {
        record(Opcode::footer, Bytes(footer_bytes, 0));
        file_.insert(file_.end(), magic.begin(), magic.end());
        return *this;
    }
    const Bytes& file() const { return file_; }
    Bytes& file() { return file_; }

 private:
    template <class T>
    Builder& append_record(const T& value) {
        append(file_, value);
        return *this;
    }

    Bytes file_;
};

/// The records of a chunk with one channel and one message.
Bytes small_records() {
    Bytes records;
    append(records, Channel{1, 0, "topic", "cdr", {}});
    append(records, MessageHead{1, 1, 2, 3}, as_bytes("data"));
    return records;
}

ChunkHead chunk_of(const Bytes& records) {
    ChunkHead chunk;
    chunk.uncompressed_bytes = records.size();
    chunk.uncompressed_crc = crc32(0, records);
    chunk.records = records;
    return chunk;
}

TEST(McapReader, what_is_no_mcap_file_is_refused_by_name) {
    EXPECT_THAT(read_all(Bytes{}).error, "run.mcap: byte 0: the file is empty");
    const std::string text = "this is some other file\n";
    EXPECT_THAT(read_all(Bytes(text.begin(), text.end())).error,
                StartsWith("run.mcap: byte 0: this is not an MCAP file"));
    EXPECT_THAT(read_all(Bytes(magic.begin(), magic.end() - 3)).error, HasSubstr("ends within"));
}

TEST(McapReader, reads_a_file_without_chunks_and_without_summary) {
    const auto back = read_all(Builder()
                                   .schema(1)
                                   .channel(1, 1)
                                   .message(1, "a")
                                   .message(1, "")
                                   .data_end()
                                   .footer()
                                   .file());
    EXPECT_EQ(back.error, "");
    ASSERT_EQ(back.messages.size(), 2U);
    EXPECT_EQ(back.messages[0], (Expected{"topic", 1, 2, 3, "a"}));
}

TEST(McapReader, the_smallest_file_of_the_specification_is_sound) {
    EXPECT_EQ(read_all(Builder().footer().file()).error, "");
}

TEST(McapReader, passes_over_records_it_does_not_know) {
    const auto back = read_all(Builder()
                                   .record(static_cast<Opcode>(0x90), std::string(200'000, 'z'))
                                   .channel(1, 0)
                                   .record(static_cast<Opcode>(0x42), "")
                                   .message(1, "a")
                                   .data_end()
                                   .record(static_cast<Opcode>(0x91), "later")
                                   .footer()
                                   .file());
    EXPECT_EQ(back.error, "");
    EXPECT_EQ(back.messages.size(), 1U);
}

TEST(McapReader, passes_over_unknown_records_and_fields_in_a_chunk) {
    auto records = small_records();
    const auto begin = begin_record(records, static_cast<Opcode>(0x99));
    ByteWriter(records).u32(7);
    end_record(records, begin);
    Builder builder;
    Bytes content;
    append(content, chunk_of(records));
    content.erase(content.begin(), content.begin() + record_head_bytes);
    ByteWriter(content).u64(12345);  // A field of a later version.
    builder.record(Opcode::chunk, content).data_end().footer();
    const auto back = read_all(builder.file());
    EXPECT_EQ(back.error, "");
    EXPECT_EQ(back.messages.size(), 1U);
}

TEST(McapReader, checks_the_crc_of_an_attachment) {
    Bytes content;
    ByteWriter writer(content);
    writer.u64(1);
    writer.u64(2);
    writer.string("mask.png");
    writer.string("image/png");
    writer.u64(100'000);
    writer.bytes(Bytes(100'000, 5));
    writer.u32(crc32(0, content));
    EXPECT_EQ(
        read_all(Builder().record(Opcode::attachment, content).data_end().footer().file()).error,
        "");
    content[5000] ^= 1;
    EXPECT_THAT(
        read_all(Builder().record(Opcode::attachment, content).data_end().footer().file()).error,
        HasSubstr("the attachment's CRC is wrong"));
    EXPECT_THAT(
        read_all(Builder().record(Opcode::attachment, "abc").data_end().footer().file()).error,
        HasSubstr("malformed"));
}

TEST(McapReader, a_message_of_an_undefined_channel_is_damage) {
    EXPECT_THAT(read_all(Builder().message(4, "a").file()).error,
                HasSubstr("a message on channel 4, which the file does not define"));
    Bytes records;
    append(records, MessageHead{4, 1, 2, 3}, as_bytes("data"));
    EXPECT_THAT(read_all(Builder().chunk(chunk_of(records)).file()).error,
                HasSubstr("at byte 0 of the uncompressed chunk: a message on channel 4"));
}

TEST(McapReader, a_channel_that_is_defined_twice_must_be_the_same) {
    EXPECT_EQ(read_all(Builder().channel(1, 0).channel(1, 0).footer().file()).error, "");
    EXPECT_THAT(read_all(Builder().channel(1, 0).channel(1, 0, "other").footer().file()).error,
                HasSubstr("channel 1 differs from its first record"));
    EXPECT_THAT(read_all(Builder().channel(1, 3).footer().file()).error,
                HasSubstr("refers to schema 3"));
}

TEST(McapReader, a_chunk_with_an_unknown_compression_is_named) {
    const auto records = small_records();
    auto chunk = chunk_of(records);
    chunk.compression = "lz4";
    EXPECT_THAT(read_all(Builder().chunk(chunk).file()).error,
                HasSubstr("compression is \"lz4\"; zstd and none are read"));
}

TEST(McapReader, a_chunk_that_would_fill_the_memory_is_refused) {
    // 64 MiB of zeros in a few kB.
    const Bytes zeros(64 << 20, 0);
    Bytes compressed;
    ASSERT_TRUE(ZstdCompressor(1).compress(zeros, compressed));
    ASSERT_LT(compressed.size(), 10'000U);
    ReadLimits limits;
    limits.uncompressed_bytes = 1 << 20;
    auto chunk = chunk_of(zeros);
    chunk.compression = "zstd";
    chunk.records = compressed;
    EXPECT_THAT(read_all(Builder().chunk(chunk).file(), limits).error,
                HasSubstr("declares 67108864 bytes uncompressed; at most 1048576 are read"));
    chunk.uncompressed_bytes = 1000;  // A lie about its size.
    EXPECT_THAT(read_all(Builder().chunk(chunk).file(), limits).error,
                HasSubstr("zstd cannot decompress it"));
    chunk.uncompressed_bytes = zeros.size() + 1;
    EXPECT_THAT(read_all(Builder().chunk(chunk).file()).error,
                HasSubstr("decompresses to 67108864 bytes instead of the 67108865 it declares"));
}

TEST(McapReader, an_absurd_length_is_refused_before_memory_is_taken) {
    Bytes file = Builder().file();
    ByteWriter writer(file);
    writer.u8(static_cast<std::uint8_t>(Opcode::chunk));
    writer.u64(UINT64_MAX);
    EXPECT_THAT(read_all(file).error,
                HasSubstr("ends within a Chunk record of 18446744073709551615 bytes, of which 0"));
    ReadLimits limits;
    limits.record_bytes = 50;
    EXPECT_THAT(
        read_all(Builder().record(Opcode::schema, std::string(51, 'x')).file(), limits).error,
        HasSubstr("a record of 51 bytes; at most 50 are read"));
}

TEST(McapReader, too_many_definitions_are_refused) {
    ReadLimits limits;
    limits.definition_bytes = 100;
    Builder builder;
    for (std::uint16_t i = 1; i < 10; ++i) builder.channel(i, 0);
    EXPECT_THAT(read_all(builder.file(), limits).error, HasSubstr("more than 100 bytes"));
}

TEST(McapReader, bytes_behind_the_end_are_a_fault) {
    auto sample = make_sample(Compression::zstd, 1, 1, 3);
    sample.file.push_back(0);
    const auto back = read_all(sample.file);
    EXPECT_EQ(back.messages, sample.messages);
    EXPECT_THAT(back.error, HasSubstr("1 bytes follow the file's end"));
}

TEST(McapReader, a_disk_error_is_reported_as_such) {
    class Broken final : public Input {
     public:
        Result<std::uint64_t> size() override { return 1 << 20; }
        Result<std::size_t> read_at(std::uint64_t, std::span<std::uint8_t>) override {
            return fail("run.mcap: cannot read: Input/output error");
        }
    };
    const auto reader = Reader::open(std::make_unique<Broken>(), "run.mcap");
    ASSERT_FALSE(reader);
    EXPECT_THAT(reader.error().message, HasSubstr("Input/output error"));
}

TEST(McapReader, a_damaged_chunk_can_be_skipped) {
    const auto sample = make_sample(Compression::zstd, 1, 4, 10);
    auto file = sample.file;
    // The second chunk: after the first Chunk record there is its index, then the next one.
    auto whole = Reader::open(std::make_unique<MemoryInput>(file), "run.mcap");
    std::vector<ChunkPlace> places;
    while (const auto message = *whole->next()) {
        if (places.empty() || places.back().offset != whole->chunk()->offset) {
            places.push_back(*whole->chunk());
        }
    }
    ASSERT_EQ(places.size(), 4U);
    file[places[0].offset + places[0].bytes / 2] ^= 4;
    const auto stopped = read_all(file);
    EXPECT_TRUE(stopped.messages.empty());
    EXPECT_THAT(stopped.error,
                StartsWith("run.mcap: byte " + std::to_string(places[0].offset) + ": the chunk"));

    auto reader =
        Reader::open(std::make_unique<MemoryInput>(file), "run.mcap", {}, OnDamage::skip_chunk);
    const auto back = read_all(reader);
    EXPECT_EQ(back.messages.size(), 30U);
    EXPECT_EQ(back.messages.front(), sample.messages[10]);
    EXPECT_EQ(reader->totals().damaged_chunks, 1U);
    EXPECT_EQ(reader->condition(), Condition::damaged);
    EXPECT_THAT(back.error, StartsWith("run.mcap: byte " + std::to_string(places[0].offset)));
}

}  // namespace
}  // namespace pursuit::recorder::mcap
