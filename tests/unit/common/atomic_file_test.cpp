// SPDX-License-Identifier: Apache-2.0
#include "services/common/atomic_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace pursuit {
namespace {

using testing::HasSubstr;

TEST(WriteFileAtomically, leaves_the_new_content_and_no_temporary_file) {
    const auto folder = std::filesystem::temp_directory_path() / "pursuit_text_format_test";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directory(folder);
    const auto path = (folder / "a").string();
    ASSERT_TRUE(write_file_atomically(path, "one"));
    ASSERT_TRUE(write_file_atomically(path, "two"));
    std::ifstream in(path);
    std::string content;
    in >> content;
    EXPECT_EQ(content, "two");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
    std::filesystem::remove_all(folder);
}

TEST(WriteFileAtomically, says_why_it_cannot_write) {
    const auto ok = write_file_atomically("/nonexistent/a", "x");
    ASSERT_FALSE(ok);
    EXPECT_THAT(ok.error().message, HasSubstr("/nonexistent/a"));
}

}  // namespace
}  // namespace pursuit
