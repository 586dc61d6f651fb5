// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/info.hpp"

#include <gmock/gmock.h>

#include "tests/unit/recorder/mcap_sample.hpp"

namespace pursuit::recorder::mcap {
namespace {

using testing::HasSubstr;

Info info_of(const Bytes& file, InfoDepth depth) {
    const auto info = read_info(std::make_unique<MemoryInput>(file), "run.mcap", depth);
    EXPECT_TRUE(info) << info.error().message;
    return info.value_or(Info{});
}

TEST(McapInfo, counts_what_a_sound_file_holds) {
    const auto sample = make_sample(Compression::zstd, 2, 3, 10);
    std::uint64_t bytes = 0;
    for (const auto& message : sample.messages) bytes += message.data.size();
    const auto info = info_of(sample.file, InfoDepth::full);
    EXPECT_EQ(info.condition, Condition::closed);
    EXPECT_FALSE(info.from_summary);
    EXPECT_TRUE(info.faults.empty());
    EXPECT_EQ(info.file_bytes, sample.file.size());
    EXPECT_EQ(info.messages, 30U);
    EXPECT_EQ(info.chunks, 3U);
    EXPECT_GT(info.compression_ratio(), 1.0);
    EXPECT_NEAR(info.duration_s(), 0.029, 1e-12);
    ASSERT_EQ(info.channels.size(), 2U);
    EXPECT_EQ(info.channels[0].schema_name, "type_0");
    EXPECT_EQ(info.channels[0].messages + info.channels[1].messages, 30U);
    EXPECT_EQ(*info.channels[0].bytes + *info.channels[1].bytes, bytes);
    EXPECT_EQ(info.channels[1].messages, 5U);
    EXPECT_NEAR(*info.channels[1].rate_hz, 500, 1e-6);
    ASSERT_EQ(info.metadata.size(), 1U);
    EXPECT_EQ(info.metadata[0].values.at("host"), "here");
}

TEST(McapInfo, the_summary_says_the_same_as_the_data) {
    const auto sample = make_sample(Compression::zstd, 3, 3, 10);
    const auto quick = info_of(sample.file, InfoDepth::summary);
    const auto full = info_of(sample.file, InfoDepth::full);
    EXPECT_TRUE(quick.from_summary);
    EXPECT_EQ(quick.messages, full.messages);
    EXPECT_EQ(quick.chunks, full.chunks);
    EXPECT_EQ(quick.compressed_bytes, full.compressed_bytes);
    EXPECT_EQ(quick.uncompressed_bytes, full.uncompressed_bytes);
    EXPECT_EQ(quick.first_log_time_ns, full.first_log_time_ns);
    EXPECT_EQ(quick.last_log_time_ns, full.last_log_time_ns);
    ASSERT_EQ(quick.channels.size(), full.channels.size());
    for (std::size_t i = 0; i < full.channels.size(); ++i) {
        EXPECT_EQ(quick.channels[i].channel, full.channels[i].channel);
        EXPECT_EQ(quick.channels[i].messages, full.channels[i].messages);
        EXPECT_EQ(quick.channels[i].schema_name, full.channels[i].schema_name);
    }
}

TEST(McapInfo, names_every_damaged_chunk_and_counts_the_rest) {
    auto sample = make_sample(Compression::zstd, 1, 5, 10);
    auto reader = Reader::open(std::make_unique<MemoryInput>(sample.file), "run.mcap");
    std::vector<ChunkPlace> places;
    while (const auto message = *reader->next()) {
        if (places.empty() || places.back().offset != reader->chunk()->offset) {
            places.push_back(*reader->chunk());
        }
    }
    for (const auto chunk : {1U, 3U}) {
        sample.file[places[chunk].offset + places[chunk].bytes - 3] ^= 1;
    }
    const auto info = info_of(sample.file, InfoDepth::full);
    EXPECT_EQ(info.condition, Condition::damaged);
    EXPECT_EQ(info.messages, 30U);
    EXPECT_EQ(info.damaged_chunks, 2U);
    ASSERT_GE(info.faults.size(), 2U);
    EXPECT_THAT(info.faults[0], HasSubstr("byte " + std::to_string(places[1].offset)));
    EXPECT_THAT(info.faults[1], HasSubstr("byte " + std::to_string(places[3].offset)));
}

TEST(McapInfo, a_file_without_channels_has_no_times) {
    const auto info = info_of(make_sample(Compression::none, 0, 1, 0).file, InfoDepth::full);
    EXPECT_EQ(info.messages, 0U);
    EXPECT_FALSE(info.first_log_time_ns);
    EXPECT_EQ(info.duration_s(), 0);
    EXPECT_EQ(info.compression_ratio(), 1);
    EXPECT_THAT(to_text(info), HasSubstr("closed cleanly"));
}

TEST(McapInfo, the_text_names_topics_rates_and_faults) {
    auto sample = make_sample(Compression::zstd, 2, 3, 10);
    sample.file.resize(sample.file.size() - 5);
    const auto text = to_text(info_of(sample.file, InfoDepth::full));
    EXPECT_THAT(text, HasSubstr("condition:   cut short"));
    EXPECT_THAT(text, HasSubstr("topic/1  type_1  5 messages"));
    EXPECT_THAT(text, HasSubstr("500.0 Hz"));
    EXPECT_THAT(text, HasSubstr("fault:       run.mcap: byte "));
    EXPECT_THAT(text, HasSubstr("2023-11-14 22:13:20.001 UTC"));
}

}  // namespace
}  // namespace pursuit::recorder::mcap
