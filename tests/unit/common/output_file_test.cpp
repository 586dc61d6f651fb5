// SPDX-License-Identifier: Apache-2.0
#include "services/common/output_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/largest_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pursuit {
namespace {

TEST(Output, is_refused_where_it_is_the_input_under_another_name) {
    const test::TemporaryFolder folder;
    const std::string input = folder.file("run.dat", "events");
    const std::string link = folder.path("link.dat");
    std::filesystem::create_symlink(input, link);
    for (const std::string& output : {input, link, folder.path(".") + "/run.dat"}) {
        const auto ok = check_is_not_input(output, input);
        ASSERT_FALSE(ok) << output;
        EXPECT_THAT(ok.error().message, testing::StartsWith(output + ": is the input"));
    }
}

TEST(Output, may_be_another_file_of_the_same_content_or_not_be_there) {
    const test::TemporaryFolder folder;
    const std::string input = folder.file("run.dat", "events");
    EXPECT_TRUE(check_is_not_input(folder.file("copy.dat", "events"), input));
    EXPECT_TRUE(check_is_not_input(folder.path("new.dat"), input));
    EXPECT_TRUE(check_is_not_input(input, folder.path("not_there.dat")));
}

TEST(Outputs, are_refused_where_both_are_or_would_be_one_file) {
    const test::TemporaryFolder folder;
    const std::string there = folder.file("a.csv", "old");
    const std::string link = folder.path("link.csv");
    std::filesystem::create_symlink(there, link);
    const auto error = check_are_two_outputs(link, there).error().message;
    EXPECT_THAT(error, testing::StartsWith(link + ": is also the output " + there));
    const std::string other_name = folder.path(".") + "/new.csv";
    EXPECT_FALSE(check_are_two_outputs(folder.path("new.csv"), other_name));
    EXPECT_TRUE(check_are_two_outputs(folder.path("new.csv"), there));
    EXPECT_TRUE(check_are_two_outputs(folder.path("new.csv"), folder.path("newer.csv")));
}

TEST(Output, keeps_what_a_file_holds_until_the_new_is_written) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("a.csv", "what was there");
    {
        auto given_up = OutputFile::create(path);
        ASSERT_TRUE(given_up && given_up->write("new"));
    }
    EXPECT_EQ(test::content_of(path), "what was there");
    auto file = OutputFile::create(path);
    ASSERT_TRUE(file && file->write("new") && file->close());
    EXPECT_EQ(test::content_of(path), "new");
    auto empty = OutputFile::create(path);
    ASSERT_TRUE(empty && empty->close());
    EXPECT_EQ(test::content_of(path), "");
}

TEST(Output, of_more_than_its_buffer_replaces_all_that_was_there) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("a.csv", std::string(3'000'000, 'o'));
    const std::string part(100'000, 'n');
    auto file = OutputFile::create(path);
    ASSERT_TRUE(file);
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(file->write(part));
    ASSERT_TRUE(file->close());
    EXPECT_EQ(test::content_of(path), std::string(1'000'000, 'n'));
}

TEST(Output, says_that_a_disk_is_full) {
    auto file = OutputFile::create("/dev/full");
    ASSERT_TRUE(file && file->write("new"));
    EXPECT_THAT(file->close().error().message, testing::StartsWith("/dev/full: cannot write: "));
}

TEST(Output, of_which_only_a_part_finds_room_is_an_error) {
    const test::TemporaryFolder folder;
    const std::string path = folder.path("a.csv");
    auto file = OutputFile::create(path);
    ASSERT_TRUE(file && file->write(std::string(100, 'n')));
    Result<void> ok;
    {
        const test::LargestFile bound(60);
        ok = file->close();
    }
    ASSERT_FALSE(ok);
    EXPECT_EQ(ok.error().message, path + ": cannot write: File too large");
    EXPECT_EQ(std::filesystem::file_size(path), 60U);
}

}  // namespace
}  // namespace pursuit
