// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/offline_track.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/ctl/pose_csv.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pursuit::ctl {
namespace {

using testing::HasSubstr;

/// 100 events in 10 ms around a square that stands at (50, 50).
std::string standing_square() {
    std::string text;
    for (int i = 0; i < 100; ++i) {
        const int along = i % 20 - 10;
        const int x = i % 2 == 0 ? 50 + along : 50 + (i % 4 == 1 ? 10 : -10);
        const int y = i % 2 == 0 ? 50 + (i % 4 == 0 ? 10 : -10) : 50 + along;
        text += "0.0" + std::to_string(10'000 + 100 * i) + " " + std::to_string(x) + " " +
                std::to_string(y) + " 1\n";
    }
    return text;
}

OfflineTrack task_of(const test::TemporaryFolder& folder, const std::string& events) {
    OfflineTrack task;
    task.events = folder.file("events.txt", events);
    task.models = {folder.file("model_square.csv", "x_px,y_px\n-10,-10\n10,-10\n10,10\n-10,10\n") +
                   "@50,50,0"};
    task.poses = folder.path("poses.csv");
    return task;
}

TEST(OfflineTrack, writes_the_poses_of_the_grid_up_to_the_last_event) {
    const test::TemporaryFolder folder;
    const auto task = task_of(folder, standing_square());
    const auto done = track_offline(task);
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(done->counters.events_in, 100U);
    const auto rows = read_pose_csv(task.poses);
    ASSERT_TRUE(rows) << rows.error().message;
    ASSERT_FALSE(rows->empty());
    EXPECT_EQ(rows->size(), done->counters.poses_emitted);
    for (std::size_t i = 0; i < rows->size(); ++i) {
        const auto& row = (*rows)[i];
        EXPECT_EQ(row.model, "square");
        EXPECT_EQ(row.object_id, 1U);
        EXPECT_EQ(row.t_us, (*rows)[0].t_us + 1000 * static_cast<std::int64_t>(i));
    }
    EXPECT_EQ(rows->back().t_us, 19'000);
}

TEST(OfflineTrack, gives_the_same_file_each_time) {
    const test::TemporaryFolder folder;
    auto task = task_of(folder, standing_square());
    ASSERT_TRUE(track_offline(task));
    const auto first = test::content_of(task.poses);
    task.poses = folder.path("again.csv");
    ASSERT_TRUE(track_offline(task));
    EXPECT_EQ(test::content_of(task.poses), first);
    EXPECT_GT(first.size(), pose_csv_header.size());
}

TEST(OfflineTrack, keeps_the_poses_before_an_error_in_the_recording) {
    const test::TemporaryFolder folder;
    auto task = task_of(folder, standing_square());
    ASSERT_TRUE(track_offline(task));
    const auto whole = test::content_of(task.poses);
    task.events = folder.file("events.txt", standing_square() + "0.5 999 1 1\n");
    const auto done = track_offline(task);
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message, HasSubstr("line 101"));
    EXPECT_EQ(test::content_of(task.poses), whole);
}

TEST(OfflineTrack, does_not_write_over_its_recording) {
    const test::TemporaryFolder folder;
    auto task = task_of(folder, standing_square());
    task.poses = folder.path(".") + "/events.txt";
    const auto done = track_offline(task);
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message, HasSubstr("is the input"));
    EXPECT_EQ(test::content_of(task.events), standing_square());
}

TEST(OfflineTrack, does_not_write_over_a_model_its_edges_or_its_configuration) {
    const test::TemporaryFolder folder;
    auto task = task_of(folder, standing_square());
    const auto edges = folder.file("model_square_edges.csv", "from,to\n0,1\n1,2\n2,3\n3,0\n");
    const auto bar = folder.file("model_bar.csv", "x_px,y_px\n-9,0\n9,0\n0,3\n");
    task.config_path = folder.file("tracker.textproto", "model: \"model_bar.csv\"\n");
    task.config.add_model(bar);
    for (const auto& input : {folder.path("model_square.csv"), edges, bar, task.config_path}) {
        const auto content = test::content_of(input);
        task.poses = input;
        const auto done = track_offline(task);
        ASSERT_FALSE(done) << input;
        EXPECT_THAT(done.error().message, HasSubstr(input + ": is the input"));
        EXPECT_EQ(test::content_of(input), content);
    }
}

TEST(OfflineTrack, refuses_an_image_of_more_pixels_than_the_tracker_takes) {
    const test::TemporaryFolder folder;
    auto task = task_of(folder, standing_square());
    task.geometry = Geometry{65'535, 65'535};
    const auto done = track_offline(task);
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message, HasSubstr("an image of 65535x65535"));
}

TEST(OfflineTrack, names_what_it_cannot_use) {
    const test::TemporaryFolder folder;
    const auto error_of = [](const OfflineTrack& task) {
        const auto done = track_offline(task);
        return done ? "" : done.error().message;
    };
    const auto good = task_of(folder, standing_square());
    auto task = good;
    task.models.clear();
    EXPECT_THAT(error_of(task), HasSubstr("no model"));
    task = good;
    task.models.push_back(good.models[0] + ",0.5,7");
    EXPECT_THAT(error_of(task), HasSubstr("x,y,theta[,scale]"));
    task = good;
    task.events = folder.path("none.txt");
    EXPECT_THAT(error_of(task), HasSubstr("none.txt: cannot open"));
    task = good;
    task.config.set_preset("best");
    EXPECT_THAT(error_of(task), HasSubstr("best"));
    task = good;
    task.config.set_strategy("guess");
    EXPECT_THAT(error_of(task), HasSubstr("strategy: unknown \"guess\""));
    task = good;
    auto* parameter = task.config.add_parameter();
    parameter->set_name("gaet_px");
    parameter->set_value(4);
    EXPECT_THAT(error_of(task), HasSubstr("gaet_px"));
    task = good;
    task.poses = "/dev/full";
    EXPECT_THAT(error_of(task), HasSubstr("/dev/full"));
}

}  // namespace
}  // namespace pursuit::ctl
