// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/recorder/record/files_fixture.hpp"

namespace pursuit::recorder {
namespace {

TEST_F(Files, that_have_no_room_for_what_they_begin_with_are_not_begun) {
    const auto disk = std::make_shared<mcap::MemoryOutput::Disk>();
    auto files = sequence({path("a.mcap"), {}, 0, on(disk)});
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

TEST_F(Files, that_take_not_even_their_beginning_are_removed) {
    const auto disk = std::make_shared<mcap::MemoryOutput::Disk>();
    disk->fail_at = 0;
    auto files = sequence({path("a.mcap"), {}, 0, on(disk)});
    ASSERT_TRUE(files.begin({}));
    EXPECT_NE(files.totals().fault, "");
    EXPECT_FALSE(std::filesystem::exists(path("a.mcap")));
}

TEST_F(Files, of_another_recorder_that_was_faster_stay) {
    auto files = sequence({path("a.mcap"), {}, 0, [](const std::string& path) {
                               std::ofstream(path) << "another's";
                               return mcap::FileOutput::create(path);
                           }});
    ASSERT_TRUE(files.begin({}));
    EXPECT_THAT(files.totals().fault, ::testing::HasSubstr("File exists"));
    EXPECT_EQ(test::content_of(path("a.mcap")), "another's");
}

TEST_F(Files, that_are_given_up_stay_where_they_hold_something_of_their_own) {
    for (const bool holds : {false, true}) {
        const auto name = path(holds ? "some.mcap" : "none.mcap");
        const auto disk = std::make_shared<mcap::MemoryOutput::Disk>();
        auto files = sequence({name, {}, 0, on(disk)});
        ASSERT_TRUE(files.begin({}));
        if (holds) files.write(sample(1), {});
        files.tick({200'000, 0});
        disk->fail_at = disk->writes + disk->flushes;
        files.write(sample(2), {200'000, 0});
        files.tick({400'000, 0});
        EXPECT_THAT(files.totals().fault, ::testing::HasSubstr("No space left on device"));
        EXPECT_EQ(files.totals().lost_disk, 1U);
        EXPECT_EQ(std::filesystem::exists(name), holds);
    }
}

TEST_F(Files, refuse_a_message_too_large_and_go_on) {
    mcap::WriterOptions options;
    options.max_message_bytes = 10;
    auto files = sequence({path("a.mcap"), options, 0});
    ASSERT_TRUE(files.begin({}));
    auto large = sample(1);
    large.payload.resize(11);
    files.write(large, {});
    files.write(sample(2), {});
    files.close({});
    EXPECT_EQ(files.totals().lost_refused, 1U);
    EXPECT_EQ(files.totals().topics_lost[0], 1U);
    EXPECT_EQ(files.totals().messages, 1U);
    EXPECT_EQ(files.totals().topics[0].bytes, 5U);
    EXPECT_THAT(errors_, ::testing::ElementsAre(::testing::HasSubstr("of 11 bytes; at most 10")));
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

}  // namespace
}  // namespace pursuit::recorder
