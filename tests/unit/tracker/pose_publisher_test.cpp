// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/pose_publisher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/support/manual_clock.hpp"

namespace pursuit::tracker {
namespace {

using ::testing::ElementsAre;

/// A publisher, and what it hands to a middleware that takes samples or does not.
struct Published {
    pursuit::test::ManualClock clock;
    bool takes = true;
    std::vector<v1::ObjectPose> poses;
    std::vector<v1::PoseTrack> tracks;
    PosePublisher publisher{1, clock,
                            [this](v1::ObjectPose& pose) {
                                poses.push_back(pose);
                                return takes;
                            },
                            [this](v1::PoseTrack& track) {
                                tracks.push_back(track);
                                return takes;
                            },
                            [](const PoseRecord&) {}};

    void pose(std::uint32_t object_id) {
        PoseRecord record;
        record.object_id = object_id;
        publisher.pose(record);
    }
    void updates(std::uint32_t object_id, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            publisher.update({.object_id = object_id,
                              .stream_id = 7,
                              .t_us = static_cast<std::int64_t>(i),
                              .pose = {}});
        }
    }
};

template <class Sample>
std::vector<std::uint64_t> numbers_of(const std::vector<Sample>& samples, std::uint32_t object_id) {
    std::vector<std::uint64_t> numbers;
    for (const auto& sample : samples) {
        if (sample.object_id() == object_id) numbers.push_back(sample.sequence_number());
    }
    return numbers;
}

TEST(PosePublisher, sends_what_it_has_gathered_of_an_object_that_is_removed) {
    Published published;
    published.updates(3, 2);
    published.publisher.forget(3);
    published.publisher.flush_tracks();
    published.publisher.forget(3);
    ASSERT_EQ(published.tracks.size(), 1U);
    EXPECT_EQ(published.tracks[0].object_id(), 3U);
    ASSERT_EQ(published.tracks[0].updates().size(), 2U);
    EXPECT_EQ(published.tracks[0].updates()[1].t_us(), 1);
}

TEST(PosePublisher, numbers_the_poses_of_each_object_from_1_on) {
    Published published;
    for (const std::uint32_t object_id : {3, 4, 3, 3, 4}) published.pose(object_id);
    EXPECT_THAT(numbers_of(published.poses, 3), ElementsAre(1, 2, 3));
    EXPECT_THAT(numbers_of(published.poses, 4), ElementsAre(1, 2));
    EXPECT_EQ(published.publisher.poses(), 5U);
    EXPECT_EQ(published.publisher.failures(), 0U);
    EXPECT_EQ(published.publisher.latency().samples(), 5U);
}

// Its number is used up: by the gap a reader sees that a pose is missing.
TEST(PosePublisher, counts_a_pose_that_could_not_be_written_as_a_failure_and_as_no_pose) {
    Published published;
    published.pose(3);
    published.takes = false;
    published.pose(3);
    published.takes = true;
    published.pose(3);
    EXPECT_EQ(published.publisher.poses(), 2U);
    EXPECT_EQ(published.publisher.failures(), 1U);
    EXPECT_EQ(published.publisher.latency().samples(), 2U);
    EXPECT_EQ(published.poses.back().sequence_number(), 3U);
}

TEST(PosePublisher, sends_a_track_as_soon_as_it_has_as_many_updates_as_the_message_holds) {
    Published published;
    published.updates(3, PosePublisher::max_updates - 1);
    EXPECT_TRUE(published.tracks.empty());
    published.updates(3, 2);
    ASSERT_EQ(published.tracks.size(), 1U);
    EXPECT_EQ(published.tracks[0].updates().size(), PosePublisher::max_updates);
    published.publisher.flush_tracks();
    ASSERT_EQ(published.tracks.size(), 2U);
    EXPECT_EQ(published.tracks[1].updates().size(), 1U);
}

TEST(PosePublisher, numbers_the_tracks_of_each_object_from_1_on_apart_from_its_poses) {
    Published published;
    published.pose(3);
    for (int i = 0; i < 3; ++i) {
        published.updates(3, 1);
        if (i > 0) published.updates(4, 1);
        published.publisher.flush_tracks();
    }
    EXPECT_THAT(numbers_of(published.tracks, 3), ElementsAre(1, 2, 3));
    EXPECT_THAT(numbers_of(published.tracks, 4), ElementsAre(1, 2));
    EXPECT_EQ(published.tracks[0].sensor_id(), 1U);
    EXPECT_EQ(published.tracks[0].stream_id(), 7U);
}

TEST(PosePublisher, counts_a_track_that_could_not_be_written_as_a_failure) {
    Published published;
    published.takes = false;
    published.updates(3, 1);
    published.publisher.flush_tracks();
    EXPECT_EQ(published.publisher.failures(), 1U);
    published.publisher.flush_tracks();
    EXPECT_EQ(published.tracks.size(), 1U);
}

TEST(PosePublisher, says_of_a_stall_no_more_once_ten_seconds_of_poses_have_passed) {
    constexpr std::int64_t s_ns = 1'000'000'000;
    pursuit::test::ManualClock clock(3 * s_ns, 3 * s_ns);
    PosePublisher publisher(
        1, clock, [](v1::ObjectPose&) { return true; }, [](v1::PoseTrack&) { return true; },
        [](const PoseRecord&) {});
    publisher.packet(0, 0);
    publisher.pose({});
    EXPECT_EQ(publisher.latency().max_us(), 3e6);
    for (int second = 1; second <= 12; ++second) {
        clock.advance(s_ns);
        publisher.packet(0, clock.realtime_ns());
        publisher.pose({});
    }
    EXPECT_EQ(publisher.latency().max_us(), 0);
}

}  // namespace
}  // namespace pursuit::tracker
