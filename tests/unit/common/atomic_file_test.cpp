// SPDX-License-Identifier: Apache-2.0
#include "services/common/atomic_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "tests/support/largest_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pursuit {
namespace {

using testing::HasSubstr;

long files_in(const test::TemporaryFolder& folder) {
    return std::distance(std::filesystem::directory_iterator(folder.path("")), {});
}

TEST(WriteFileAtomically, leaves_the_new_content_and_no_temporary_file) {
    const test::TemporaryFolder folder;
    const auto path = folder.path("a");
    ASSERT_TRUE(write_file_atomically(path, "one"));
    ASSERT_TRUE(write_file_atomically(path, "two"));
    EXPECT_EQ(test::content_of(path), "two");
    EXPECT_EQ(files_in(folder), 1);
}

TEST(WriteFileAtomically, replaces_the_file_that_a_link_leads_to_and_keeps_the_link) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder.path("far"));
    const auto target = folder.file("far/target", "old");
    const auto link = folder.path("link");
    std::filesystem::create_symlink("far/second", link);
    std::filesystem::create_symlink(target, folder.path("far/second"));
    for (const auto* content : {"one", "two"}) {
        const auto ok = write_output(link, content);
        ASSERT_TRUE(ok) << ok.error().message;
        EXPECT_TRUE(std::filesystem::is_symlink(link));
        EXPECT_TRUE(std::filesystem::is_symlink(folder.path("far/second")));
        EXPECT_EQ(test::content_of(target), content);
        EXPECT_EQ(files_in(folder), 2);
    }
}

TEST(WriteFileAtomically, makes_the_file_that_a_dangling_link_names) {
    const test::TemporaryFolder folder;
    const auto link = folder.path("link");
    std::filesystem::create_symlink("target", link);
    const auto ok = write_output(link, "one");
    ASSERT_TRUE(ok) << ok.error().message;
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(test::content_of(folder.path("target")), "one");
}

TEST(WriteFileAtomically, refuses_links_that_go_round_in_a_circle) {
    const test::TemporaryFolder folder;
    std::filesystem::create_symlink("b", folder.path("a"));
    std::filesystem::create_symlink("a", folder.path("b"));
    const auto ok = write_output(folder.path("a"), "one");
    ASSERT_FALSE(ok);
    EXPECT_EQ(ok.error().message, folder.path("a") + ": its symbolic links go round in a circle");
    EXPECT_TRUE(std::filesystem::is_symlink(folder.path("a")));
    EXPECT_EQ(files_in(folder), 2);
}

TEST(WriteFileAtomically, refuses_what_is_no_regular_file_and_leaves_it) {
    const test::TemporaryFolder folder;
    const auto fifo = folder.path("fifo");
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    const auto ok = write_file_atomically(fifo, "one");
    ASSERT_FALSE(ok);
    EXPECT_EQ(ok.error().message, fifo + ": is a FIFO, where a regular file is needed");
    EXPECT_TRUE(std::filesystem::is_fifo(fifo));
    const auto into_folder = write_output(folder.path(""), "one");
    ASSERT_FALSE(into_folder);
    EXPECT_THAT(into_folder.error().message, HasSubstr("is a folder"));
    EXPECT_EQ(files_in(folder), 1);
}

TEST(WriteOutput, writes_into_a_fifo_also_behind_a_link) {
    const test::TemporaryFolder folder;
    const auto fifo = folder.path("fifo");
    const auto link = folder.path("link");
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    std::filesystem::create_symlink("fifo", link);
    const int reader = ::open(fifo.c_str(), O_RDONLY | O_NONBLOCK);
    ASSERT_GE(reader, 0);
    for (const auto& path : {fifo, link}) {
        const auto ok = write_output(path, "model");
        ASSERT_TRUE(ok) << ok.error().message;
        char bytes[16];
        EXPECT_EQ(::read(reader, bytes, sizeof(bytes)), 5);
        EXPECT_EQ(std::string_view(bytes, 5), "model");
        EXPECT_TRUE(std::filesystem::is_fifo(fifo));
    }
    ::close(reader);
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(files_in(folder), 2);
}

TEST(WriteOutput, writes_into_a_file_that_has_lost_its_name) {
    const test::TemporaryFolder folder;
    const auto path = folder.file("a", "older and longer");
    const int file = ::open(path.c_str(), O_RDWR);
    ASSERT_GE(file, 0);
    ASSERT_EQ(::unlink(path.c_str()), 0);
    const auto ok = write_output("/proc/self/fd/" + std::to_string(file), "model");
    ASSERT_TRUE(ok) << ok.error().message;
    char bytes[32];
    EXPECT_EQ(::read(file, bytes, sizeof(bytes)), 5);
    ::close(file);
    EXPECT_EQ(files_in(folder), 0);
}

TEST(WriteFileAtomically, keeps_the_old_content_where_only_a_part_of_the_new_finds_room) {
    const test::TemporaryFolder folder;
    const auto path = folder.file("a", "old");
    Result<void> ok;
    {
        const test::LargestFile bound(60);
        ok = write_file_atomically(path, std::string(100, 'n'));
    }
    ASSERT_FALSE(ok);
    EXPECT_EQ(ok.error().message, path + ": cannot write: File too large");
    EXPECT_EQ(test::content_of(path), "old");
    EXPECT_EQ(files_in(folder), 1);
}

TEST(WriteFileAtomically, says_why_it_cannot_write) {
    const auto ok = write_file_atomically("/nonexistent/a", "x");
    ASSERT_FALSE(ok);
    EXPECT_THAT(ok.error().message, HasSubstr("/nonexistent/a"));
}

}  // namespace
}  // namespace pursuit
