// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/file_sequence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/recorder/mcap/facts.hpp"
#include "services/recorder/record/output_path.hpp"
#include "services/recorder/record/related_sample.hpp"
#include "tests/unit/recorder/record/files_fixture.hpp"

namespace pursuit::recorder {
namespace {

TEST_F(Files, keep_writers_apart_and_say_who_they_are) {
    auto files = sequence({path("a.mcap"), {}, 0});
    ASSERT_TRUE(files.begin({}));
    files.write(sample(1, 0, 0x0a), {});
    files.write(sample(2, 0, 0x0b), {});
    files.close({});
    const auto found = messages(path("a.mcap"));
    ASSERT_EQ(found.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        const auto facts = mcap::replay_facts(found[i].channel);
        ASSERT_TRUE(facts && *facts);
        EXPECT_EQ((*facts)->writer_guid, to_hex(sample(1, 0, i == 0 ? 0x0a : 0x0b).id.writer));
        EXPECT_EQ((*facts)->writer_guid.substr(0, 4), i == 0 ? "0a0a" : "0b0b");
        EXPECT_TRUE((*facts)->keyed);
        EXPECT_EQ((*facts)->history_depth, 16U);
        EXPECT_EQ(found[i].channel.metadata.at("pursuit.flow"), "poses");
    }
    EXPECT_EQ(files.totals().messages, 2U);
    EXPECT_EQ(files.totals().topics[0].bytes, 10U);
}

TEST_F(Files, hold_disposes_and_the_request_behind_a_reply) {
    auto files = sequence({path("a.mcap"), {}, 0});
    ASSERT_TRUE(files.begin({}));
    auto dispose = sample(1);
    dispose.kind = SampleKind::disposed;
    dispose.payload.clear();
    dispose.instance.fill(9);
    files.write(dispose, {});
    auto reply = sample(2, 1);
    reply.related.writer.fill(7);
    reply.related.sequence = 0x1'0000'0002;
    files.write(reply, {});
    files.close({});
    const auto found = messages(path("a.mcap"));
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(found[0].channel.message_encoding, mcap::instance_state_encoding);
    EXPECT_EQ(found[0].channel.schema_id, 0U);
    mcap::Bytes state(17, 9);
    state[0] = 0b101;  // disposed, with the key hash
    EXPECT_EQ(found[0].data, state);
    EXPECT_EQ(found[2].channel.topic, "pursuit/tracker/reply");
    EXPECT_EQ(found[2].channel.message_encoding, related_sample_encoding);
    mcap::Bytes request(16, 7);
    request.insert(request.end(), {2, 0, 0, 0, 1, 0, 0, 0});
    EXPECT_EQ(found[2].data, request);
}

TEST_F(Files, begin_a_next_one_at_the_size_that_is_set_and_lose_nothing) {
    mcap::WriterOptions options;
    options.compression = mcap::Compression::none;
    auto files = sequence({path("a.mcap"), options, 60'000});
    ASSERT_TRUE(files.begin({}));
    std::size_t sent = 0;
    for (; sent < 200; ++sent) {
        auto large = sample(static_cast<std::uint8_t>(sent));
        large.payload.resize(1000);
        files.write(large, {});
    }
    files.close({});
    std::size_t found = 0;
    for (const auto* name : {"a.mcap", "a-1.mcap", "a-2.mcap", "a-3.mcap", "a-4.mcap"}) {
        for (const auto& message : messages(path(name))) {
            EXPECT_EQ(message.data[4], found++);
        }
        if (std::filesystem::exists(path(name))) {
            EXPECT_LT(std::filesystem::file_size(path(name)), 80'000U);
        }
    }
    EXPECT_EQ(found, sent);
    EXPECT_EQ(files.totals().messages, sent);
    EXPECT_TRUE(std::filesystem::exists(path("a-3.mcap")));
}

TEST_F(Files, but_the_first_begin_with_what_was_latched_then) {
    auto files = sequence({path("a.mcap"), {}, 0});
    ASSERT_TRUE(files.begin({}));
    for (const auto& sample : {model(7, 1), model(8, 2), model(7, 3), model(9, 4, 0x0c)}) {
        files.write(sample, {});
    }
    files.write(sample(5), {});
    gone_.insert(model(9, 4, 0x0c).id.writer);
    ASSERT_TRUE(files.new_file({}));
    // They are there before anything else comes.
    const auto begun = messages(path("a-1.mcap"));
    ASSERT_EQ(begun.size(), 2U);
    EXPECT_EQ(begun[0].data, model(7, 3).payload);
    EXPECT_EQ(begun[1].data, model(8, 2).payload);
    for (const auto& message : begun) {
        EXPECT_EQ(message.head.log_time_ns, sample(5).reception_time_ns);
        EXPECT_EQ(message.head.publish_time_ns, 100 + message.data[4]);
        EXPECT_EQ(message.head.sequence, message.data[4]);
    }
    files.write(sample(6), {});
    files.close({});
    EXPECT_EQ(messages(path("a-1.mcap")).size(), 3U);
    EXPECT_EQ(files.totals().messages, 6U);
    EXPECT_EQ(files.totals().topics[2].messages, 4U);
}

TEST_F(Files, hold_as_much_of_their_own_as_what_they_begin_with_whatever_size_is_set) {
    mcap::WriterOptions options;
    options.compression = mcap::Compression::none;
    auto files = sequence({path("a.mcap"), options, 10'000});
    ASSERT_TRUE(files.begin({}));
    auto large = model(7, 1);
    large.payload.resize(50'000, 1);
    files.write(large, {});
    for (std::uint8_t i = 0; i < 120; ++i) {
        auto pose = sample(i);
        pose.payload.resize(1000);
        files.write(pose, {});
    }
    files.close({});
    EXPECT_EQ(files.totals().file, path("a-3.mcap"));
    EXPECT_EQ(files.totals().messages, 121U);
}

TEST_F(Files, begin_a_next_one_where_the_index_of_one_is_full) {
    mcap::WriterOptions options;
    options.chunk_bytes = 1;  // each message is a chunk
    options.max_index_bytes = 300;
    auto files = sequence({path("a.mcap"), options, 0});
    ASSERT_TRUE(files.begin({}));
    for (std::uint8_t i = 0; i < 10; ++i) files.write(sample(i), {});
    files.close({});
    const auto first = messages(path("a.mcap"));
    const auto second = messages(path("a-1.mcap"));
    ASSERT_FALSE(second.empty());
    EXPECT_EQ(second.front().data[4], first.size());
    EXPECT_EQ(files.totals().messages, 10U);
}

TEST_F(Files, tell_once_that_more_is_latched_than_is_kept) {
    auto files = sequence({path("a.mcap"), {}, 0});
    ASSERT_TRUE(files.begin({}));
    auto latched = model(0, 1);
    for (std::size_t i = 0; i < LatchedSamples::most_samples + 2; ++i) {
        EXPECT_EQ(errors_.size(), i > LatchedSamples::most_samples ? 1U : 0U) << i;
        latched.instance[0] = static_cast<std::uint8_t>(i);
        latched.instance[1] = static_cast<std::uint8_t>(i >> 8);
        files.write(latched, {});
    }
    EXPECT_THAT(errors_, ::testing::ElementsAre(::testing::HasSubstr(
                             "pursuit/models: too much is latched to keep it")));
}

TEST_F(Files, count_the_gaps_of_their_event_streams_and_of_nothing_else) {
    auto files = sequence({path("a.mcap"), {}, 0});
    ASSERT_TRUE(files.begin({}));
    for (const std::uint64_t number : {0, 1, 5}) files.write(packet(number), {});
    EXPECT_EQ(files.totals().gaps, 1U);
    auto gone = packet(9);
    gone.kind = SampleKind::disposed;
    auto pose = packet(9);
    pose.topic = 0;
    for (const auto& none : {gone, pose}) files.write(none, {});
    EXPECT_EQ(files.totals().gaps, 1U);
}

TEST_F(Files, take_the_first_free_name) {
    EXPECT_EQ(free_path(path("a.b.mcap")), path("a.b.mcap"));
    std::ofstream(path("a.b.mcap")) << "";
    EXPECT_EQ(free_path(path("a.b.mcap")), path("a.b-1.mcap"));
    std::filesystem::create_symlink("/nowhere", path("a.b-1.mcap"));
    EXPECT_EQ(free_path(path("a.b.mcap")), path("a.b-2.mcap"));
}

TEST(OutputPath, has_the_time_of_the_start_in_utc) {
    EXPECT_EQ(expand_time("/x/%t-%t.mcap", 1'767'323'045'999'999'999),
              "/x/20260102T030405Z-20260102T030405Z.mcap");
    EXPECT_EQ(expand_time("plain", 0), "plain");
}

}  // namespace
}  // namespace pursuit::recorder
