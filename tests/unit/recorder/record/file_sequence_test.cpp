// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/file_sequence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "services/recorder/mcap/facts.hpp"
#include "services/recorder/mcap/reader.hpp"
#include "services/recorder/record/output_path.hpp"
#include "services/recorder/record/related_sample.hpp"
#include "tests/unit/recorder/mcap_sample.hpp"

namespace pursuit::recorder {
namespace {

class Files : public ::testing::Test {
 protected:
    Files() {
        char pattern[] = "/tmp/pursuit-files-XXXXXX";
        folder_ = ::mkdtemp(pattern);
    }
    ~Files() override { std::filesystem::remove_all(folder_); }

    FileSequence sequence(FileOptions options) {
        return FileSequence(
            std::move(options), topics_,
            [this](auto&, const Guid& writer) {
                OfferedQos offered;
                offered.gone = gone_.contains(writer);
                return offered;
            },
            [this](const std::string& error) { errors_.push_back(error); });
    }
    static Sample sample(std::uint8_t content, std::size_t topic = 0, std::uint8_t writer = 1) {
        Sample sample;
        sample.topic = topic;
        sample.id.writer.fill(writer);
        sample.id.sequence = content;
        sample.reception_time_ns = 1000 + content;
        sample.payload = {0, 1, 0, 0, content};
        return sample;
    }
    static Sample model(std::uint8_t instance, std::uint8_t content, std::uint8_t writer = 1) {
        auto model = sample(content, 2, writer);
        model.instance.fill(instance);
        model.source_time_ns = 100 + content;
        return model;
    }
    struct Message {
        mcap::MessageHead head;
        mcap::Channel channel;
        mcap::Bytes data;
    };
    static std::vector<Message> messages(const std::string& path) {
        std::vector<Message> found;
        auto input = mcap::FileInput::open(path);
        if (!input) return found;
        auto reader = mcap::Reader::open(std::move(*input), path);
        while (reader) {
            const auto message = reader->next();
            if (!message || !*message) break;
            found.push_back({(*message)->head,
                             *(*message)->channel,
                             {(*message)->data.begin(), (*message)->data.end()}});
        }
        return found;
    }
    std::string path(const std::string& name) const { return folder_ + "/" + name; }

    std::string folder_;
    std::vector<TopicFacts> topics_ = {
        {"pursuit/poses", "pursuit::v1::ObjectPose", true, "poses", 16},
        {"pursuit/tracker/reply", "pursuit::v1::TrackerReply", false, "calls", 128},
        {"pursuit/models", "pursuit::v1::RegisteredModel", true, "latched", 1}};
    std::set<Guid> gone_;
    std::vector<std::string> errors_;
};

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
    const auto state = mcap::decode_instance_state(found[0].data);
    ASSERT_TRUE(state);
    EXPECT_TRUE(state->disposed && !state->unregistered);
    EXPECT_EQ(state->key_hash, dispose.instance);
    EXPECT_EQ(found[2].channel.topic, "pursuit/tracker/reply");
    EXPECT_EQ(found[2].channel.message_encoding, related_sample_encoding);
    EXPECT_EQ(decode_related(found[2].data), reply.related);
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

TEST_F(Files, that_have_no_room_for_what_they_begin_with_are_not_begun) {
    const auto disk = std::make_shared<mcap::MemoryOutput::Disk>();
    auto files = sequence({path("a.mcap"), {}, 0, [&](const std::string& path) {
                               std::ofstream(path) << std::string(100, ' ');
                               return std::make_unique<mcap::MemoryOutput>(disk);
                           }});
    ASSERT_TRUE(files.begin({}));
    files.write(model(7, 1), {});
    files.tick({200'000, 0});
    disk->fail_at = 3;  // the fourth call: the magic, two definitions, then the chunk
    EXPECT_FALSE(files.new_file({}));
    EXPECT_THAT(files.totals().fault, ::testing::HasSubstr("No space left on device"));
    EXPECT_TRUE(std::filesystem::exists(path("a.mcap")));
    EXPECT_FALSE(std::filesystem::exists(path("a-1.mcap")));
    disk->fail_at = -1;
    files.tick({1'200'000, 0});
    EXPECT_EQ(files.totals().fault, "");
    EXPECT_EQ(files.totals().file, path("a-1.mcap"));
}

TEST_F(Files, that_cannot_be_written_are_tried_again_every_second_and_what_is_lost_is_counted) {
    const auto place = path("place");
    std::filesystem::create_directory(place);
    auto files = sequence({place + "/a.mcap", {}, 0});
    ASSERT_TRUE(files.begin({}));
    files.write(sample(1), {});
    std::filesystem::remove_all(place);
    EXPECT_FALSE(files.new_file({}));
    EXPECT_THAT(files.totals().fault, ::testing::HasSubstr("No such file or directory"));
    files.write(sample(2), {});
    files.tick({900'000, 0});
    std::filesystem::create_directory(place);
    files.tick({999'999, 0});
    EXPECT_FALSE(files.totals().fault.empty());
    files.tick({1'000'000, 0});
    EXPECT_EQ(files.totals().fault, "");
    files.write(sample(3), {1'000'000, 0});
    files.close({1'000'000, 0});
    EXPECT_EQ(messages(place + "/a.mcap").size(), 1U);
    EXPECT_EQ(files.totals().lost_disk, 1U);
    EXPECT_EQ(files.totals().topics_lost[0], 1U);
    EXPECT_EQ(errors_.size(), 1U);
}

TEST_F(Files, that_find_the_disk_full_at_the_start_are_tried_again_like_later_ones) {
    const auto disk = std::make_shared<mcap::MemoryOutput::Disk>();
    disk->fail_at = 0;
    auto files = sequence(
        {path("a.mcap"), {}, 0, [&](auto&) { return std::make_unique<mcap::MemoryOutput>(disk); }});
    ASSERT_TRUE(files.begin({}));
    EXPECT_THAT(files.totals().fault, ::testing::HasSubstr("No space left on device"));
    files.write(sample(1), {});
    EXPECT_EQ(files.totals().lost_disk, 1U);
    disk->fail_at = -1;
    files.tick({1'000'000, 0});
    EXPECT_EQ(files.totals().fault, "");
    EXPECT_EQ(files.totals().file, path("a.mcap"));
}

TEST_F(Files, that_cannot_be_written_are_told_of_once_whatever_they_are_called) {
    const auto place = path("place");
    std::filesystem::create_directory(place);
    auto files = sequence({place + "/%t.mcap", {}, 0});
    ASSERT_TRUE(files.begin({}));
    std::filesystem::remove_all(place);
    EXPECT_FALSE(files.new_file({}));
    for (std::int64_t second = 1; second <= 3; ++second) {
        files.tick({second * 1'000'000, second * 1'000'000'000});
    }
    EXPECT_EQ(errors_.size(), 1U);
    // Another reason is told.
    std::ofstream(place) << "";
    files.tick({4'000'000, 4'000'000'000});
    EXPECT_EQ(errors_.size(), 2U);
    EXPECT_THAT(files.totals().fault, ::testing::HasSubstr("Not a directory"));
}

TEST_F(Files, that_cannot_be_flushed_count_what_they_hold_as_lost) {
    for (const std::int64_t flush_interval_us : {0, 1'000'000}) {
        const auto disk = std::make_shared<mcap::MemoryOutput::Disk>();
        FileOptions options{path("a.mcap"), {}, 0, [&](auto&) {
                                return std::make_unique<mcap::MemoryOutput>(disk);
                            }};
        options.writer.flush_interval_us = flush_interval_us;
        auto files = sequence(std::move(options));
        ASSERT_TRUE(files.begin({}));
        files.write(sample(1), {});
        files.tick({1'000'000, 0});
        EXPECT_EQ(files.totals().messages, 1U);
        files.write(sample(2), {1'000'000, 0});
        disk->fail_at = disk->writes + disk->flushes + 1;  // not the chunk's write, its flush
        files.tick({1'200'000, 0});
        if (flush_interval_us > 0) files.tick({2'200'000, 0});
        EXPECT_EQ(files.totals().fault, "disk: cannot flush: Input/output error");
        EXPECT_EQ(files.totals().chunks_written, 2U);
        EXPECT_EQ(files.totals().messages, 1U);
        EXPECT_EQ(files.totals().topics[0].messages, 1U);
        EXPECT_EQ(files.totals().lost_disk, 1U);
        EXPECT_EQ(files.totals().topics_lost[0], 1U);
    }
}

TEST_F(Files, that_cannot_be_begun_are_an_error_with_the_path) {
    auto files = sequence({path("nowhere/a.mcap"), {}, 0});
    const auto begun = files.begin({});
    ASSERT_FALSE(begun);
    EXPECT_THAT(begun.error().message, ::testing::HasSubstr(path("nowhere/a.mcap")));
    EXPECT_FALSE(sequence({path(std::string(300, 'a')), {}, 0}).begin({}));
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
