// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/pose_publisher.hpp"

#include <gtest/gtest.h>

#include "tests/support/manual_clock.hpp"

namespace pursuit::tracker {
namespace {

TEST(PosePublisher, sends_what_it_has_gathered_of_an_object_that_is_removed) {
    pursuit::test::ManualClock clock;
    std::vector<v1::PoseTrack> tracks;
    PosePublisher publisher(
        1, clock, [](v1::ObjectPose&) { return true; },
        [&](v1::PoseTrack& track) {
            tracks.push_back(track);
            return true;
        },
        [](const PoseRecord&) {});
    publisher.update({.object_id = 3, .stream_id = 7, .t_us = 10, .pose = {}});
    publisher.update({.object_id = 3, .stream_id = 7, .t_us = 11, .pose = {}});
    publisher.forget(3);
    publisher.flush_tracks();
    publisher.forget(3);
    ASSERT_EQ(tracks.size(), 1U);
    EXPECT_EQ(tracks[0].object_id(), 3U);
    ASSERT_EQ(tracks[0].updates().size(), 2U);
    EXPECT_EQ(tracks[0].updates()[1].t_us(), 11);
}

}  // namespace
}  // namespace pursuit::tracker
