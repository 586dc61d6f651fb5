// SPDX-License-Identifier: Apache-2.0
// Recordings on a real disk: what it refuses, and what is left of one whose writer was killed.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "services/recorder/mcap/writer.hpp"
#include "tests/support/largest_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/recorder/mcap_sample.hpp"

namespace pursuit::recorder::mcap {
namespace {

using testing::HasSubstr;

TEST(McapFile, a_recording_never_replaces_another) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(FileOutput::create(folder.path("a.mcap")));
    const auto again = FileOutput::create(folder.path("a.mcap"));
    ASSERT_FALSE(again);
    EXPECT_THAT(again.error().message, HasSubstr("a.mcap: cannot create: File exists"));
}

TEST(McapFile, a_file_that_cannot_be_opened_is_named) {
    const test::TemporaryFolder folder;
    const auto missing = FileInput::open(folder.path("none.mcap"));
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().message, HasSubstr("none.mcap: cannot open: No such file"));
    EXPECT_THAT(FileInput::open(folder.path("")).error().message, HasSubstr("not a regular file"));
    EXPECT_FALSE(FileOutput::create(folder.path("no/such/folder.mcap")));
}

TEST(McapFile, a_full_disk_is_an_error) {
    const int file = ::open("/dev/full", O_WRONLY);
    ASSERT_GE(file, 0);
    const auto writer = Writer::create(std::make_unique<FileOutput>(file, "/dev/full"), {}, 0);
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.error().message, "/dev/full: cannot write: No space left on device");
}

TEST(McapFile, of_which_only_a_part_finds_room_is_an_error) {
    const test::TemporaryFolder folder;
    auto output = FileOutput::create(folder.path("a.mcap"));
    ASSERT_TRUE(output);
    Result<void> ok;
    {
        const test::LargestFile bound(60);
        ok = (*output)->write(Bytes(100, 1));
    }
    ASSERT_FALSE(ok);
    EXPECT_EQ(ok.error().message, folder.path("a.mcap") + ": cannot write: File too large");
    EXPECT_EQ(std::filesystem::file_size(folder.path("a.mcap")), 60U);
}

TEST(McapFile, that_cannot_be_flushed_is_an_error) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    FileOutput pipe(ends[1], "pipe");  // fdatasync(2) takes no pipe
    ASSERT_TRUE(pipe.write(as_bytes("data")));
    const auto ok = pipe.flush();
    ASSERT_FALSE(ok);
    EXPECT_EQ(ok.error().message, "pipe: cannot flush: Invalid argument");
    ::close(ends[0]);
}

TEST(McapFile, a_writer_that_is_killed_loses_only_its_open_chunk) {
    const test::TemporaryFolder folder;
    const auto child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        auto output = FileOutput::create(folder.path("killed.mcap"));
        auto writer = Writer::create(std::move(*output), {}, 0);
        const auto schema = writer->add_schema("T", "omgidl", "struct T { long a; };");
        const auto channel = writer->add_channel(*schema, "topic", "cdr", {});
        for (std::uint32_t i = 0; i < 105; ++i) {
            if (!writer->write({*channel, i, i, i}, as_bytes("data"))) ::_exit(1);
            if (!writer->tick(i * 20'000)) ::_exit(1);
        }
        ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    auto reader = Reader::open(*FileInput::open(folder.path("killed.mcap")), "killed.mcap");
    const auto back = read_all(reader);
    EXPECT_GE(back.messages.size(), 95U);
    EXPECT_LT(back.messages.size(), 105U);
    EXPECT_THAT(back.error, HasSubstr("without having been closed"));
    EXPECT_EQ(reader->condition(), Condition::not_closed);
}

}  // namespace
}  // namespace pursuit::recorder::mcap
