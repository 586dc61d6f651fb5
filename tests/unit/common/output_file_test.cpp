// SPDX-License-Identifier: Apache-2.0
#include "services/common/output_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

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

}  // namespace
}  // namespace pursuit
