// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/recording/run_report.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temporary_folder.hpp"
#include "tests/system/recording_builder.hpp"

namespace pursuit::ctl {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

v1::ObjectPose pose_at(std::int64_t t_us) {
    v1::ObjectPose pose;
    pose.object_id(1);
    pose.model("square");
    pose.sequence_number(static_cast<std::uint64_t>(t_us / 1000));
    pose.t_us(t_us);
    pose.state(v1::TRACK_TRACKING);
    pose.x_px(static_cast<double>(t_us) * 1e-5);
    pose.a00(1);
    pose.a11(1);
    pose.confidence(1);
    return pose;
}

/// Of a square that moves by 10 px/s, a pose every ms.
RecordedRun run_of(int seconds) {
    RecordedRun run;
    run.first_t_us = 0;
    run.last_t_us = 1'000'000 * seconds;
    v1::RegisteredModel model;
    model.name("square");
    for (const float x : {-9.F, 9.F}) {
        for (const float y : {-9.F, 9.F}) {
            v1::ModelPoint point;
            point.x_px(x);
            point.y_px(y);
            model.points().push_back(point);
        }
    }
    run.models[1] = model;
    for (std::int64_t t_us = 0; t_us <= *run.last_t_us; t_us += 1000) {
        const auto pose = pose_at(t_us);
        run.poses[1].push_back({t_us, pose.state(), pose.x_px(), pose.y_px(), 1, 0, 0, 1, 1});
    }
    return run;
}

TEST(RunReport, truth_that_goes_on_after_the_recording_is_no_loss) {
    const auto truth = object_rows(run_of(9));
    const auto page = make_report(run_of(3), truth, "");
    ASSERT_EQ(page.objects.size(), 1U);
    EXPECT_EQ(page.objects[0].lost, false);
    EXPECT_NEAR(page.objects[0].mean_error_px.value(), 0, 1e-9);
    EXPECT_EQ(page.objects[0].truth.back().t_us, 3'000'000);
    EXPECT_TRUE(verdict(page).good) << verdict(page).text;
}

TEST(RunReport, an_object_that_stands_still_until_the_recording_ends_is_lost) {
    auto run = run_of(9);
    run.poses[1].resize(3000);
    const auto page = make_report(run, object_rows(run_of(9)), "");
    EXPECT_EQ(page.objects[0].lost, true);
}

TEST(RunReport, truth_of_another_time_is_none) {
    auto run = run_of(1);
    auto truth = object_rows(run);
    for (auto& t_us : truth[0].t_us) t_us += 2e6;
    const auto page = make_report(run, truth, "");
    EXPECT_FALSE(page.objects[0].lost);
    EXPECT_TRUE(page.objects[0].truth.empty());
}

TEST(RunReport, a_fault_of_the_recording_is_a_loss) {
    auto run = run_of(1);
    run.faults = {"run.mcap: byte 7: damaged"};
    const auto page = make_report(run, {}, "");
    EXPECT_FALSE(verdict(page).good);
    EXPECT_THAT(verdict(page).text, HasSubstr("1 faults in the recording"));
}

TEST(RunReport, a_lost_object_is_no_lost_data) {
    auto run = run_of(1);
    v1::NamedCount lost;
    lost.name("objects.lost.gone");
    lost.count(1);
    run.tracker.emplace();
    run.tracker->dropped_by({lost});
    EXPECT_TRUE(verdict(make_report(run, {}, "")).good) << verdict(make_report(run, {}, "")).text;
    lost.name("queue_full");
    run.tracker->dropped_by({lost});
    EXPECT_THAT(verdict(make_report(run, {}, "")).text, HasSubstr("dropped by queue_full"));
}

TEST(ReadRun, counts_calls_of_which_the_reply_alone_was_recorded) {
    const test::TemporaryFolder folder;
    const auto path = folder.path("run.mcap");
    pursuit::testing::RecordingBuilder recording(path, {topic::events, topic::tracker_reply});
    recording.add_packets(1);
    v1::TrackerReply reply;
    reply.result().set_occlusion_strategy({});
    recording.add(topic::tracker_reply, 1, pursuit::testing::serialized(reply));
    recording.close();
    const auto run = read_run(path, 0, 0);
    ASSERT_TRUE(run);
    EXPECT_EQ(run->calls_missing, 1U);
}

TEST(RunReport, a_call_that_is_not_in_the_recording_is_a_loss) {
    auto run = run_of(1);
    run.calls_missing = 1;
    EXPECT_THAT(verdict(make_report(run, {}, "")).text,
                HasSubstr("1 calls missing in the recording"));
}

std::string recording_of_poses(const test::TemporaryFolder& folder, int count) {
    const auto path = folder.path("run.mcap");
    pursuit::testing::RecordingBuilder recording(path, {topic::events, topic::poses});
    recording.add_packets(1);
    for (int i = 0; i < count; ++i) {
        recording.add(topic::poses, i, pursuit::testing::serialized(pose_at(1000 * i)));
    }
    recording.close();
    return path;
}

TEST(ReadRun, tells_how_many_poses_it_left_out) {
    const test::TemporaryFolder folder;
    const auto path = recording_of_poses(folder, 10);
    const auto whole = read_run(path, 0, 0, 10);
    ASSERT_TRUE(whole) << whole.error().message;
    EXPECT_EQ(whole->poses.at(1).size(), 10U);
    EXPECT_THAT(whole->faults, ElementsAre());
    const auto cut = read_run(path, 0, 0, 4);
    ASSERT_TRUE(cut);
    EXPECT_EQ(cut->poses.at(1).size(), 4U);
    EXPECT_THAT(cut->faults, ElementsAre(path + ": 6 poses left out, after 4"));
}

TEST(ReadRun, tells_of_a_flipped_byte) {
    const test::TemporaryFolder folder;
    const auto path = recording_of_poses(folder, 100);
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    const auto middle = static_cast<std::streamoff>(std::filesystem::file_size(path) / 2);
    file.seekg(middle);
    const int byte = file.get();
    file.seekp(middle);
    file.put(static_cast<char>(byte ^ 1));
    file.close();
    const auto run = read_run(path, 0, 0);
    ASSERT_TRUE(run) << run.error().message;
    EXPECT_FALSE(run->faults.empty());
}

}  // namespace
}  // namespace pursuit::ctl
