// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/model_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "tests/support/temporary_folder.hpp"

namespace pursuit::tracker {
namespace {

using ::testing::HasSubstr;

StoredObject object(std::uint32_t id, const std::string& name, bool tracked) {
    StoredObject entry;
    entry.object.object_id = id;
    entry.object.shape.name = name;
    entry.object.shape.points_px = {{-10.1F, 0}, {10.1F, -0.3F}, {0, 0.3F}};
    entry.object.shape.edges = {{0, 1}, {1, 2}};
    entry.object.transform = TransformKind::similarity;
    entry.object.estimator = EstimatorKind::gradient;
    entry.object.start.pose = pose_of(0.1, 1.0 / 3, 2.5, 1.7, 1.7);
    entry.object.start.velocity.vx_px_s = 1e-300;
    entry.object.parameters.gate_px = 5.1;
    if (tracked) {
        entry.track = TrackSnapshot{.object_id = id,
                                    .state = TrackState::occluded,
                                    .was_tracked = true,
                                    .t_us = 987'654'321'012,
                                    .pose = pose_of(152.1, 119.9, -1.1, 1.6, 1.6),
                                    .velocity = {.vx_px_s = 42.1, .vy_px_s = -0.1}};
    }
    return entry;
}

StoredState state() {
    StoredState state;
    state.moment.stream_id = 0xfedcba9876543210;
    state.moment.last_t_us = 987'654'321'987;
    state.next_object_id = 9;
    state.settings.strategy = StrategyKind::closest;
    state.settings.strategy_parameters = {{"ambiguity_px", 2.9}};
    state.settings.parameters = {{"coast_s", 0.7}, {"gate_px", 3.3}};
    state.objects = {object(1, "van", true), object(8, "car", false)};
    return state;
}

void expect_same(const StoredState& a, const StoredState& b) {
    EXPECT_EQ(a.moment, b.moment);
    EXPECT_EQ(a.next_object_id, b.next_object_id);
    EXPECT_EQ(a.settings, b.settings);
    ASSERT_EQ(a.objects.size(), b.objects.size());
    for (std::size_t i = 0; i < a.objects.size(); ++i) {
        const auto& one = a.objects[i];
        const auto& two = b.objects[i];
        EXPECT_EQ(one.object.object_id, two.object.object_id);
        EXPECT_EQ(one.object.shape, two.object.shape);
        EXPECT_EQ(one.object.transform, two.object.transform);
        EXPECT_EQ(one.object.estimator, two.object.estimator);
        EXPECT_EQ(one.object.start, two.object.start);
        EXPECT_EQ(one.object.parameters, two.object.parameters);
        ASSERT_EQ(one.track.has_value(), two.track.has_value());
        if (!one.track) continue;
        EXPECT_EQ(one.track->state, two.track->state);
        EXPECT_EQ(one.track->t_us, two.track->t_us);
        EXPECT_EQ(one.track->pose, two.track->pose);
        EXPECT_EQ(one.track->velocity, two.track->velocity);
    }
}

TEST(ModelStore, gives_back_every_bit_of_what_was_stored) {
    const auto read = decode_store(encode_store(state()));
    ASSERT_TRUE(read) << read.error().message;
    expect_same(*read, state());
}

TEST(ModelStore, gives_back_an_empty_tracker) {
    const auto read = decode_store(encode_store({}));
    ASSERT_TRUE(read) << read.error().message;
    expect_same(*read, {});
}

TEST(ModelStore, refuses_a_file_cut_at_any_byte) {
    const std::string bytes = encode_store(state());
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_FALSE(decode_store(std::string_view(bytes).substr(0, size))) << size;
    }
}

TEST(ModelStore, refuses_a_file_with_any_bit_flipped) {
    std::string bytes = encode_store(state());
    for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
        const auto mask = static_cast<char>(1 << bit % 8);
        bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ mask);
        EXPECT_FALSE(decode_store(bytes)) << bit;
        bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ mask);
    }
    EXPECT_TRUE(decode_store(bytes));
}

TEST(ModelStore, refuses_objects_out_of_order_and_ids_that_would_be_given_again) {
    auto wrong = state();
    std::swap(wrong.objects[0], wrong.objects[1]);
    auto read = decode_store(encode_store(wrong));
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().message, HasSubstr("object_id: 1"));
    wrong = state();
    wrong.next_object_id = 8;
    read = decode_store(encode_store(wrong));
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().message, HasSubstr("object_id: 8"));
}

TEST(ModelStore, refuses_a_model_that_a_request_could_not_have_registered) {
    auto wrong = state();
    wrong.objects[1].object.shape.points_px.clear();
    const auto read = decode_store(encode_store(wrong));
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().message, HasSubstr("object 8: "));
}

TEST(ModelStore, finds_nothing_where_no_file_is) {
    const pursuit::test::TemporaryFolder folder;
    const auto read = read_store(folder.path("tracker.store"));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_FALSE(read->state);
    EXPECT_EQ(read->damage, "");
}

TEST(ModelStore, reads_back_the_file_it_has_written_over_an_older_one) {
    const pursuit::test::TemporaryFolder folder;
    const auto path = folder.path("tracker.store");
    ASSERT_TRUE(write_store(path, {}));
    ASSERT_TRUE(write_store(path, state()));
    const auto read = read_store(path);
    ASSERT_TRUE(read && read->state);
    expect_same(*read->state, state());
}

TEST(ModelStore, keeps_a_damaged_file_aside_and_names_it) {
    const pursuit::test::TemporaryFolder folder;
    const auto path = folder.file("tracker.store", "not a store");
    const auto read = read_store(path);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_FALSE(read->state);
    EXPECT_THAT(read->damage, HasSubstr(path + ": the store is damaged: "));
    EXPECT_THAT(read->damage, HasSubstr("kept as " + path + ".damaged"));
    EXPECT_FALSE(std::filesystem::exists(path));
    EXPECT_EQ(test::content_of(path + ".damaged"), "not a store");
}

TEST(ModelStore, behind_a_link_is_written_read_and_kept_aside_in_its_own_folder) {
    const pursuit::test::TemporaryFolder folder;
    std::filesystem::create_directory(folder.path("far"));
    const auto link = folder.path("tracker.store");
    std::filesystem::create_symlink("far/store", link);
    ASSERT_TRUE(write_store(link, state()));
    EXPECT_TRUE(std::filesystem::is_regular_file(folder.path("far/store")));
    const auto read = read_store(link);
    ASSERT_TRUE(read && read->state);
    expect_same(*read->state, state());
    folder.file("far/store", "not a store");
    EXPECT_FALSE(read_store(link)->state);
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(test::content_of(folder.path("far/store.damaged")), "not a store");
}

TEST(ModelStore, is_not_read_from_nor_written_over_what_is_no_regular_file) {
    const pursuit::test::TemporaryFolder folder;
    const auto fifo = folder.path("fifo");
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    const auto read = read_store(fifo);
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().message, HasSubstr("is no regular file"));
    EXPECT_FALSE(write_store(fifo, state()));
    EXPECT_TRUE(std::filesystem::is_fifo(fifo));
}

TEST(ModelStore, takes_what_cannot_be_read_or_kept_aside_for_an_error_and_not_for_nothing) {
    const pursuit::test::TemporaryFolder folder;
    const auto path = folder.path("tracker.store");
    std::filesystem::create_directory(path);
    auto read = read_store(path);
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().message, HasSubstr(path + ": is no regular file"));
    std::filesystem::remove(path);
    std::filesystem::create_symlink(path, path);
    read = read_store(path);
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().message, HasSubstr(path + ": cannot be looked for: "));
    std::filesystem::remove(path);
    folder.file("tracker.store", "not a store");
    std::filesystem::create_directory(path + ".damaged");
    read = read_store(path);
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().message, HasSubstr("it cannot be kept aside: "));
    EXPECT_EQ(test::content_of(path), "not a store");
}

TEST(ModelStore, tells_that_a_folder_cannot_be_written) {
    const pursuit::test::TemporaryFolder folder;
    const auto written = write_store(folder.path("missing/tracker.store"), state());
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error().message, HasSubstr("missing/tracker.store"));
}

}  // namespace
}  // namespace pursuit::tracker
