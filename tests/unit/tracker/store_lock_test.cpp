// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/store_lock.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/temporary_folder.hpp"

namespace pursuit::tracker {
namespace {

using ::testing::HasSubstr;

TEST(StoreLock, is_had_by_one_at_a_time_and_names_the_store_to_others) {
    const pursuit::test::TemporaryFolder folder;
    const std::string path = folder.path("tracker.store");
    {
        const auto first = StoreLock::take(path);
        ASSERT_TRUE(first);
        EXPECT_EQ(first->problem(), "");
        const auto second = StoreLock::take(path);
        ASSERT_FALSE(second);
        EXPECT_THAT(second.error().message, HasSubstr(path + ": the store is in use"));
    }
    EXPECT_TRUE(StoreLock::take(path)) << "the first has ended";
}

TEST(StoreLock, holds_while_the_store_is_replaced_and_moved_with) {
    const pursuit::test::TemporaryFolder folder;
    const std::string path = folder.file("tracker.store", "old");
    StoreLock lock;
    lock = *StoreLock::take(path);
    std::filesystem::rename(folder.file("new", "new"), path);
    EXPECT_FALSE(StoreLock::take(path));
}

TEST(StoreLock, is_one_for_a_store_and_a_link_to_it) {
    const pursuit::test::TemporaryFolder folder;
    const std::string path = folder.file("tracker.store", "");
    std::filesystem::create_symlink(path, folder.path("link"));
    const auto lock = StoreLock::take(path);
    ASSERT_TRUE(lock);
    EXPECT_FALSE(StoreLock::take(folder.path("link")));
}

TEST(StoreLock, says_why_it_could_not_be_had_in_a_folder_that_is_not_there) {
    const pursuit::test::TemporaryFolder folder;
    const auto lock = StoreLock::take(folder.path("missing/tracker.store"));
    ASSERT_TRUE(lock);
    EXPECT_THAT(lock->problem(), HasSubstr("missing/tracker.store.lock: No such file"));
}

}  // namespace
}  // namespace pursuit::tracker
