// SPDX-License-Identifier: Apache-2.0
#include "services/common/small_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/temporary_folder.hpp"

namespace pursuit {
namespace {

TEST(SmallFile, is_read_whole_whatever_its_size) {
    const test::TemporaryFolder folder;
    for (const std::size_t size : {0, 1, 65535, 65536, 65537, 1 << 20}) {
        const std::string content(size, 'x');
        const auto text = read_small_file(folder.file("a", content), 1);
        ASSERT_TRUE(text) << text.error().message;
        EXPECT_EQ(*text, content);
    }
}

TEST(SmallFile, of_proc_which_states_no_size_is_read) {
    const auto text = read_small_file("/proc/self/status", 1);
    ASSERT_TRUE(text) << text.error().message;
    EXPECT_EQ(text->substr(0, 5), "Name:");
}

TEST(SmallFile, that_is_larger_than_the_bound_is_refused) {
    const test::TemporaryFolder folder;
    const auto path = folder.file("a", std::string((1 << 20) + 1, 'x'));
    const auto text = read_small_file(path, 1);
    ASSERT_FALSE(text);
    EXPECT_EQ(text.error().message, path + ": larger than 1 MiB");
}

TEST(SmallFile, is_no_folder_device_or_fifo_and_none_of_them_is_waited_for) {
    const test::TemporaryFolder folder;
    const auto fifo = folder.path("fifo");
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    const auto message_of = [](const std::string& path) {
        const auto text = read_small_file(path, 1);
        return text ? "" : text.error().message;
    };
    EXPECT_EQ(message_of(fifo), fifo + ": is not a regular file");
    EXPECT_EQ(message_of("/dev/zero"), "/dev/zero: is not a regular file");
    EXPECT_EQ(message_of("/tmp"), "/tmp: is a folder");
    EXPECT_EQ(message_of("/nowhere"), "/nowhere: cannot open: No such file or directory");
}

}  // namespace
}  // namespace pursuit
