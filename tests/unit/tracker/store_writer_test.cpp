// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/store_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <future>

#include "tests/support/temporary_folder.hpp"

namespace pursuit::tracker {
namespace {

using ::testing::HasSubstr;

StoredState state_with(std::uint32_t next_object_id) {
    StoredState state;
    state.next_object_id = next_object_id;
    return state;
}

/// A writer whose folder is not there yet. The destructor ends after all that was asked for.
struct WithoutFolder {
    pursuit::test::TemporaryFolder folder;
    const std::string path = folder.path("later/tracker.store");
    std::promise<std::string> first_error;
    int errors = 0;
    int recoveries = 0;
    std::unique_ptr<StoreWriter> writer = std::make_unique<StoreWriter>(
        path,
        [this](const std::string& message) {
            if (++errors == 1) first_error.set_value(message);
        },
        [this] { ++recoveries; });

    void make_folder() const { std::filesystem::create_directory(folder.path("later")); }
    std::uint32_t stored_next_id() const {
        const auto found = read_store(path);
        return found && found->state ? found->state->next_object_id : 0;
    }
};

TEST(StoreWriter, writes_again_what_could_not_be_written_once_it_is_told_to) {
    WithoutFolder store;
    store.writer->post(state_with(7));
    EXPECT_THAT(store.first_error.get_future().get(), HasSubstr(store.path));
    EXPECT_THAT(store.writer->failure(), HasSubstr(store.path));
    store.make_folder();
    store.writer->retry();
    store.writer.reset();
    EXPECT_EQ(store.stored_next_id(), 7U);
    EXPECT_EQ(store.recoveries, 1);
}

TEST(StoreWriter, tells_of_failures_once_and_writes_the_newest_state_only) {
    WithoutFolder store;
    store.writer->post(state_with(7));
    store.first_error.get_future().get();
    store.writer->retry();
    store.writer->post(state_with(8));
    store.writer.reset();
    EXPECT_EQ(store.errors, 1);
    EXPECT_EQ(store.recoveries, 0);
}

TEST(StoreWriter, has_nothing_to_try_again_where_all_was_written) {
    WithoutFolder store;
    store.make_folder();
    store.writer->post(state_with(7));
    store.writer->retry();
    store.writer.reset();
    EXPECT_EQ(store.stored_next_id(), 7U);
    EXPECT_EQ(store.errors + store.recoveries, 0);
}

}  // namespace
}  // namespace pursuit::tracker
