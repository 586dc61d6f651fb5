// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/live_poses.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pursuit::ctl {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

v1::ObjectPose pose_of(std::uint32_t sensor_id, std::uint32_t object_id,
                       std::uint64_t sequence_number) {
    v1::ObjectPose pose;
    pose.sensor_id(sensor_id);
    pose.object_id(object_id);
    pose.sequence_number(sequence_number);
    pose.model("van" + std::to_string(object_id));
    return pose;
}

PoseCounter counted(std::initializer_list<std::uint64_t> sequence_numbers) {
    PoseCounter counter;
    for (const auto number : sequence_numbers) counter.add(pose_of(1, 1, number));
    return counter;
}

TEST(PoseCounter, counts_no_gap_where_every_number_follows_the_one_before) {
    for (const auto& counter : {counted({}), counted({1}), counted({1, 2, 3})}) {
        EXPECT_EQ(counter.gaps(), 0U);
        EXPECT_EQ(counter.missed(), 0U);
    }
    EXPECT_EQ(counted({1, 2, 3}).poses(), 3U);
}

TEST(PoseCounter, counts_no_gap_before_the_first_pose_it_hears) {
    const auto counter = counted({700, 701});
    EXPECT_EQ(counter.gaps(), 0U);
    EXPECT_EQ(counter.missed(), 0U);
}

TEST(PoseCounter, counts_each_gap_and_the_poses_missed_in_it) {
    EXPECT_EQ(counted({1, 3}).gaps(), 1U);
    EXPECT_EQ(counted({1, 3}).missed(), 1U);
    const auto many = counted({1, 3, 4, 10, 12});
    EXPECT_EQ(many.gaps(), 3U);
    EXPECT_EQ(many.missed(), 1U + 5U + 1U);
    EXPECT_EQ(many.poses(), 5U);
}

TEST(PoseCounter, takes_a_number_that_goes_back_for_a_tracker_started_again) {
    const auto counter = counted({8, 9, 1, 2, 4});
    EXPECT_EQ(counter.gaps(), 1U);
    EXPECT_EQ(counter.missed(), 1U);
}

TEST(PoseCounter, counts_the_objects_of_each_sensor_by_themselves) {
    PoseCounter counter;
    for (const std::uint64_t number : {1, 2}) {
        counter.add(pose_of(1, 1, number));
        counter.add(pose_of(1, 2, 10 * number));
        counter.add(pose_of(2, 1, 100 * number));
    }
    EXPECT_EQ(counter.gaps(), 2U);
    EXPECT_EQ(counter.missed(), 9U + 99U);
    EXPECT_EQ(counter.poses(), 6U);
}

TEST(PoseTable, has_the_latest_pose_of_every_object_and_how_many_there_were) {
    PoseTable table(false);
    auto pose = pose_of(1, 1, 1);
    pose.x_px(10);
    table.add(pose);
    pose.x_px(20.25);
    pose.state(v1::TRACK_TRACKING);
    pose.t_us(1'500'000);
    pose.theta_rad(std::acos(-1.0) / 2);
    table.add(pose);
    table.add(pose_of(1, 2, 1));
    const auto text = table.text();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
    EXPECT_THAT(text, StartsWith("model"));
    EXPECT_THAT(text, HasSubstr("van1                1 TRACKING       1.500     20.25      0.00"
                                "     90.0"));
    EXPECT_THAT(text, HasSubstr("       2\nvan2"));
    EXPECT_THAT(text, Not(HasSubstr("10.00")));
}

TEST(PoseTable, is_drawn_over_itself_on_a_terminal_alone) {
    PoseTable terminal(true);
    PoseTable file(false);
    for (auto* table : {&terminal, &file}) {
        table->add(pose_of(1, 1, 1));
        EXPECT_THAT(table->text(), StartsWith("model"));
        table->add(pose_of(1, 2, 1));
    }
    EXPECT_THAT(terminal.text(), StartsWith("\033[2A\033[Jmodel"));
    EXPECT_THAT(terminal.text(), StartsWith("\033[3A\033[Jmodel"));
    EXPECT_THAT(file.text(), StartsWith("model"));
}

TEST(PoseTable, is_due_once_for_what_is_new_and_not_sooner_than_its_period) {
    const std::chrono::steady_clock::time_point begin(1h);
    for (const bool terminal : {true, false}) {
        const auto period = terminal ? 100ms : 1000ms;
        PoseTable table(terminal);
        EXPECT_FALSE(table.due(begin));
        table.add(pose_of(1, 1, 1));
        EXPECT_TRUE(table.due(begin));
        EXPECT_FALSE(table.due(begin + 2 * period));
        EXPECT_FALSE(table.due(begin + 2 * period));
        table.add(pose_of(1, 1, 2));
        EXPECT_TRUE(table.due(begin + 2 * period));
        table.add(pose_of(1, 1, 3));
        EXPECT_FALSE(table.due(begin + 3 * period - 1ms));
        EXPECT_TRUE(table.due(begin + 3 * period));
    }
}

TEST(PoseJson, has_null_for_numbers_that_json_does_not_have) {
    auto pose = pose_of(3, 4, 5);
    pose.state(v1::TRACK_LOST);
    pose.transform(v1::TRANSFORM_SIMILARITY);
    pose.velocity_covariance({1, 2, 3, 4, 5, std::numeric_limits<double>::quiet_NaN()});
    const auto json = pose_json(pose);
    EXPECT_THAT(json, StartsWith(R"({"sensor_id": 3, "object_id": 4, "stream_id": 0, )"
                                 R"("sequence_number": 5, )"));
    EXPECT_THAT(json, HasSubstr(R"("transform": "similarity", "state": "LOST")"));
    EXPECT_THAT(json, HasSubstr(R"("velocity_covariance": [1, 2, 3, 4, 5, null])"));
}

TEST(PoseRow, of_a_pose_that_came_over_dds_is_the_trackers_own) {
    auto pose = pose_of(1, 7, 5);
    pose.t_us(2);
    pose.last_event_t_us(1);
    pose.state(v1::TRACK_OCCLUDED);
    pose.x_px(3);
    pose.y_px(4);
    pose.a00(5);
    pose.a01(6);
    pose.a10(7);
    pose.a11(8);
    pose.theta_rad(9);
    pose.scale_x(10);
    pose.scale_y(11);
    pose.vx_px_s(12);
    pose.vy_px_s(13);
    pose.omega_rad_s(14);
    pose.confidence(0.5F);
    pose.mean_residual_px(0.25F);
    PoseRow row;
    row.t_us = 2;
    row.last_event_t_us = 1;
    row.object_id = 7;
    row.model = "van7";
    row.state = tracker::TrackState::occluded;
    row.pose.t_px = {3, 4};
    row.pose.a << 5, 6, 7, 8;
    row.theta_rad = 9;
    row.scale_x = 10;
    row.scale_y = 11;
    row.vx_px_s = 12;
    row.vy_px_s = 13;
    row.omega_rad_s = 14;
    row.confidence = 0.5F;
    row.residual_px = 0.25F;
    EXPECT_EQ(row_of(pose), row);
}

}  // namespace
}  // namespace pursuit::ctl
