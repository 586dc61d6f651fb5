// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/writer.hpp"

#include <gmock/gmock.h>

#include "services/recorder/mcap/summary.hpp"
#include "tests/unit/recorder/mcap_sample.hpp"

namespace pursuit::recorder::mcap {
namespace {

using testing::HasSubstr;

constexpr std::int64_t ms = 1000;

struct OpenWriter {
    explicit OpenWriter(WriterOptions options = {})
        : disk(std::make_shared<MemoryOutput::Disk>()),
          writer(*Writer::create(std::make_unique<MemoryOutput>(disk), std::move(options), 0)) {
        const auto schema = writer.add_schema("T", "omgidl", "struct T { long a; };");
        channel = *writer.add_channel(*schema, "topic", "cdr", {});
    }

    Result<void> write(std::string_view data) {
        ++sequence;
        return writer.write({channel, sequence, 1000 + sequence, 900 + sequence}, as_bytes(data));
    }

    std::shared_ptr<MemoryOutput::Disk> disk;
    Writer writer;
    std::uint16_t channel = 0;
    std::uint32_t sequence = 0;
};

TEST(McapWriter, what_is_written_is_read_back_with_and_without_compression) {
    for (const auto compression : {Compression::none, Compression::zstd}) {
        for (const int channels : {1, 2, 5}) {
            const auto sample = make_sample(compression, channels, 3, 20);
            const auto back = read_all(sample.file);
            EXPECT_EQ(back.error, "");
            EXPECT_EQ(back.messages, sample.messages);
            EXPECT_EQ(back.messages.size(), 60U);
        }
    }
}

TEST(McapWriter, a_file_without_messages_is_sound) {
    for (const int channels : {0, 1}) {
        const auto back = read_all(make_sample(Compression::zstd, channels, 1, 0).file);
        EXPECT_EQ(back.error, "");
        EXPECT_TRUE(back.messages.empty());
    }
}

TEST(McapWriter, an_empty_message_and_one_larger_than_a_chunk_come_back) {
    WriterOptions options;
    options.chunk_bytes = 4096;
    OpenWriter open(options);
    const std::string large(100'000, 'x');
    ASSERT_TRUE(open.write(""));
    ASSERT_TRUE(open.write(large));
    ASSERT_TRUE(open.write("end"));
    ASSERT_TRUE(open.writer.close());
    const auto back = read_all(open.disk->data);
    ASSERT_EQ(back.messages.size(), 3U);
    EXPECT_EQ(back.messages[0].data, "");
    EXPECT_EQ(back.messages[1].data, large);
    EXPECT_EQ(back.messages[2].data, "end");
}

TEST(McapWriter, closes_a_chunk_when_it_is_large_enough) {
    WriterOptions options;
    options.compression = Compression::none;
    options.chunk_bytes = 4096;
    OpenWriter open(options);
    const std::string data(1000, 'x');
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(open.write(data));
    EXPECT_EQ(open.writer.totals().chunks, 0U);
    ASSERT_TRUE(open.write(data));
    EXPECT_EQ(open.writer.totals().chunks, 1U);
    EXPECT_EQ(open.writer.totals().open_chunk_bytes, 0U);
    EXPECT_EQ(read_all(open.disk->data).messages.size(), 4U);
}

TEST(McapWriter, closes_a_chunk_when_it_is_old_enough) {
    OpenWriter open;
    ASSERT_TRUE(open.writer.tick(300 * ms));  // The definitions alone.
    EXPECT_EQ(open.writer.totals().chunks, 1U);
    ASSERT_TRUE(open.write("a"));
    ASSERT_TRUE(open.writer.tick(499 * ms));
    EXPECT_EQ(read_all(open.disk->data).messages.size(), 0U);
    ASSERT_TRUE(open.writer.tick(500 * ms));
    EXPECT_EQ(open.writer.totals().chunks, 2U);
    EXPECT_EQ(read_all(open.disk->data).messages.size(), 1U);
    ASSERT_TRUE(open.writer.tick(10'000 * ms));
    EXPECT_EQ(open.writer.totals().chunks, 2U) << "an empty chunk was written";
}

TEST(McapWriter, every_closed_chunk_is_flushed_to_the_disk) {
    OpenWriter open;
    ASSERT_TRUE(open.write("a"));
    ASSERT_TRUE(open.writer.tick(200 * ms));
    EXPECT_EQ(open.disk->flushed, open.disk->data.size());
    EXPECT_EQ(open.writer.totals().flushed_bytes, open.writer.totals().bytes);
}

TEST(McapWriter, flushes_are_apart_by_the_interval_that_was_asked_for) {
    WriterOptions options;
    options.flush_interval_us = 1000 * ms;
    OpenWriter open(options);
    for (int i = 1; i <= 4; ++i) {
        ASSERT_TRUE(open.write("a"));
        ASSERT_TRUE(open.writer.tick(i * 200 * ms));
    }
    EXPECT_EQ(open.writer.totals().chunks, 4U);
    EXPECT_EQ(open.disk->flushes, 0);
    ASSERT_TRUE(open.writer.tick(1000 * ms));
    EXPECT_EQ(open.disk->flushes, 1);
    ASSERT_TRUE(open.writer.tick(5000 * ms));
    EXPECT_EQ(open.disk->flushes, 1) << "flushed though nothing was written";
}

TEST(McapWriter, the_same_schema_and_channel_get_the_same_id) {
    OpenWriter open;
    const auto schema = open.writer.add_schema("T", "omgidl", "struct T { long a; };");
    EXPECT_EQ(*schema, 1);
    EXPECT_EQ(*open.writer.add_channel(1, "topic", "cdr", {}), open.channel);
    EXPECT_NE(*open.writer.add_channel(1, "topic", "cdr", {{"a", "b"}}), open.channel);
    EXPECT_EQ(*open.writer.add_schema("T", "omgidl", "other"), 2);
}

TEST(McapWriter, a_call_that_makes_no_sense_is_refused_and_the_file_goes_on) {
    WriterOptions options;
    options.max_message_bytes = 10;
    options.max_definition_bytes = 2000;
    OpenWriter open(options);
    const auto bad_channel = open.writer.write({7, 0, 1, 1}, as_bytes("a"));
    ASSERT_FALSE(bad_channel);
    EXPECT_THAT(bad_channel.error().message, HasSubstr("channel 7"));
    const auto bad_time = open.writer.write({open.channel, 0, -1, 1}, as_bytes("a"));
    ASSERT_FALSE(bad_time);
    EXPECT_THAT(bad_time.error().message, HasSubstr("-1 ns"));
    const auto large = open.write("eleven bytes");
    ASSERT_FALSE(large);
    EXPECT_THAT(large.error().message, HasSubstr("topic of 12 bytes; at most 10"));
    EXPECT_FALSE(open.writer.add_channel(9, "x", "cdr", {}));
    const auto full = open.writer.add_schema("big", "omgidl", std::string(3000, 'x'));
    ASSERT_FALSE(full);
    EXPECT_THAT(full.error().message, HasSubstr("bounded to 2000 bytes"));
    ASSERT_TRUE(open.write("good"));
    ASSERT_TRUE(open.writer.close());
    const auto back = read_all(open.disk->data);
    EXPECT_EQ(back.error, "");
    ASSERT_EQ(back.messages.size(), 1U);
    EXPECT_EQ(back.messages[0].data, "good");
}

TEST(McapWriter, an_unknown_publish_time_becomes_the_log_time) {
    OpenWriter open;
    ASSERT_TRUE(open.writer.write({open.channel, 0, 77, -1}, as_bytes("a")));
    ASSERT_TRUE(open.writer.close());
    EXPECT_EQ(read_all(open.disk->data).messages[0].publish_time_ns, 77);
}

TEST(McapWriter, definitions_are_bounded_in_their_sum) {
    WriterOptions options;
    options.max_definition_bytes = 2000;
    OpenWriter open(options);
    const std::string text(800, 'x');
    EXPECT_TRUE(open.writer.add_schema("a", "omgidl", text));
    EXPECT_TRUE(open.writer.add_schema("b", "omgidl", text));
    EXPECT_FALSE(open.writer.add_schema("c", "omgidl", text));
}

TEST(McapWriter, the_start_and_end_are_those_of_messages_in_any_order) {
    OpenWriter open;
    for (const std::int64_t time_ns : {77, 50, 99, 60}) {
        ASSERT_TRUE(open.writer.write({open.channel, 0, time_ns, time_ns}, as_bytes("a")));
    }
    EXPECT_EQ(open.writer.totals().start_time_ns, 50);
    EXPECT_EQ(open.writer.totals().end_time_ns, 99);
}

TEST(McapWriter, a_disk_that_fails_at_any_call_gives_an_error_and_leaves_a_readable_file) {
    // Writes 5 chunks of 4 messages; counts the calls of a run without a failure first.
    const auto run = [](const std::shared_ptr<MemoryOutput::Disk>& disk) {
        int good = 0;
        std::string error;
        auto writer = Writer::create(std::make_unique<MemoryOutput>(disk), {}, 0);
        if (!writer) return writer.error().message;
        const auto note = [&](const auto& result) {
            if (!result && error.empty()) error = result.error().message;
            if (!result) {
                EXPECT_EQ(result.error().message, error) << "a later call hid the failure";
            }
            return result.has_value();
        };
        const auto schema = writer->add_schema("T", "omgidl", "struct T { long a; };");
        note(schema);
        note(writer->add_channel(1, "topic", "cdr", {}));
        for (std::uint32_t i = 0; i < 20; ++i) {
            if (note(writer->write({1, i, i, i}, as_bytes("data")))) ++good;
            if (i % 4 == 3) note(writer->flush());
        }
        note(writer->close());
        return error;
    };
    const auto sound = std::make_shared<MemoryOutput::Disk>();
    ASSERT_EQ(run(sound), "");
    const int calls = sound->writes + sound->flushes;
    ASSERT_GT(calls, 10);
    for (int fail_at = 0; fail_at < calls; ++fail_at) {
        for (const std::size_t partial : {0, 1, 20, 100'000}) {
            const auto disk = std::make_shared<MemoryOutput::Disk>();
            disk->fail_at = fail_at;
            disk->partial = partial;
            EXPECT_THAT(run(disk), HasSubstr("disk: cannot")) << "call " << fail_at;
            EXPECT_FALSE(disk->refused_after) << "wrote on behind a failure";
            const auto back = read_all(disk->data);
            EXPECT_EQ(back.messages.size() % 4, 0U);
            for (std::size_t i = 0; i < back.messages.size(); ++i) {
                EXPECT_EQ(back.messages[i].sequence, i);
            }
        }
    }
}

TEST(McapWriter, nothing_can_be_written_after_the_end) {
    OpenWriter open;
    ASSERT_TRUE(open.writer.close());
    const auto size = open.disk->data.size();
    EXPECT_FALSE(open.write("late"));
    EXPECT_FALSE(open.writer.close());
    EXPECT_FALSE(open.writer.tick(1));
    EXPECT_EQ(open.disk->data.size(), size);
}

TEST(McapWriter, the_summary_tells_what_the_data_holds) {
    const auto sample = make_sample(Compression::zstd, 3, 4, 25);
    MemoryInput input(sample.file);
    const auto summary = read_summary(input);
    ASSERT_TRUE(summary) << summary.error().message;
    EXPECT_EQ(summary->definitions.channels().size(), 3U);
    EXPECT_EQ(summary->definitions.schemas().size(), 2U);
    ASSERT_TRUE(summary->statistics);
    EXPECT_EQ(summary->statistics->messages, 100U);
    EXPECT_EQ(summary->statistics->metadata, 1U);
    EXPECT_EQ(summary->statistics->chunks, 4U);
    EXPECT_EQ(summary->statistics->start_time_ns, sample.messages.front().log_time_ns);
    EXPECT_EQ(summary->statistics->end_time_ns, sample.messages.back().log_time_ns);
    ASSERT_EQ(summary->chunks.size(), 4U);
    for (const auto& chunk : summary->chunks) {
        EXPECT_EQ(sample.file[chunk.chunk_offset], static_cast<std::uint8_t>(Opcode::chunk));
        for (const auto& [channel, offset] : chunk.message_index_offsets) {
            EXPECT_EQ(sample.file[offset], static_cast<std::uint8_t>(Opcode::message_index));
            EXPECT_EQ(sample.file[offset + record_head_bytes], channel);
        }
    }
}

TEST(McapWriter, a_full_chunk_index_is_left_out_and_no_message_with_it) {
    WriterOptions options;
    options.max_index_bytes = 300;
    OpenWriter open(options);
    for (int i = 0; i < 10; ++i) {
        ASSERT_TRUE(open.write("a"));
        ASSERT_TRUE(open.writer.flush());
    }
    EXPECT_TRUE(open.writer.index_full());
    ASSERT_TRUE(open.writer.close());
    const auto back = read_all(open.disk->data);
    EXPECT_EQ(back.error, "");
    EXPECT_EQ(back.messages.size(), 10U);
    MemoryInput input(open.disk->data);
    EXPECT_TRUE(read_summary(input)->chunks.empty());
}

}  // namespace
}  // namespace pursuit::recorder::mcap
