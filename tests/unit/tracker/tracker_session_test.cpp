// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/manual_clock.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

/// A session over what a former run left, and what it said of that.
struct Restarted {
    explicit Restarted(const StoredState& stored)
        : session(
              Tracker::create({}).value(), {}, stored, {}, clock,
              {[](v1::ObjectPose&) { return true; }, [](v1::PoseTrack&) { return true; },
               [](v1::RegisteredModel&) { return true; }, [](v1::TrackerSettings&) { return true; },
               [](const SessionFigures&) { return v1::TrackerStatus(); },
               [this](const std::string& message) { errors.push_back(message); },
               [](const PoseRecord&) {}}) {}

    pursuit::test::ManualClock clock;
    std::vector<std::string> errors;
    TrackerSession session;
};

StoredState tracked_at(const Pose& pose) {
    StoredState stored;
    stored.next_object_id = 2;
    StoredObject& arrow = stored.objects.emplace_back();
    arrow.object.object_id = 1;
    arrow.object.shape = test::arrow();
    arrow.object.start.pose = pose_of(50, 60, 0.5);
    arrow.track = TrackSnapshot{
        .object_id = 1, .was_tracked = true, .t_us = 1'000'000, .pose = pose, .velocity = {}};
    return stored;
}

TEST(TrackerSession, goes_on_where_an_object_was_tracked_last) {
    const Pose last = pose_of(100, 90, 1);
    Restarted restarted(tracked_at(last));
    EXPECT_TRUE(restarted.errors.empty());
    const StoredState now = restarted.session.stored_state();
    ASSERT_EQ(now.objects.size(), 1U);
    ASSERT_TRUE(now.objects[0].track);
    EXPECT_EQ(now.objects[0].track->pose.t_px, last.t_px);
}

TEST(TrackerSession, leaves_where_an_object_was_registered_as_it_was) {
    Restarted restarted(tracked_at(pose_of(100, 90, 1)));
    const StoredState now = restarted.session.stored_state();
    ASSERT_EQ(now.objects.size(), 1U);
    EXPECT_EQ(now.objects[0].object.start.pose.t_px, Eigen::Vector2d(50, 60));
}

TEST(TrackerSession, has_nothing_new_to_store_before_the_first_packet) {
    StoredState stored = tracked_at(pose_of(100, 90, 1));
    stored.moment = {7, 1'000'000};
    Restarted restarted(stored);
    EXPECT_EQ(restarted.session.stored_moment(), stored.moment);
    EXPECT_EQ(restarted.session.stored_state().moment, stored.moment);
    v1::EventPacket packet;
    packet.sensor_id(1);
    packet.stream_id(8);
    packet.base_time_us(500);
    packet.width(304);
    packet.height(240);
    restarted.session.take(packet);
    EXPECT_EQ(restarted.session.stored_moment(), (StoredMoment{8, 500}));
}

TEST(TrackerSession, begins_where_an_object_was_registered_where_its_last_pose_is_none) {
    Pose last = pose_of(100, 90, 1);
    last.t_px.x() = std::numeric_limits<double>::quiet_NaN();
    Restarted restarted(tracked_at(last));
    ASSERT_EQ(restarted.errors.size(), 1U);
    EXPECT_THAT(restarted.errors[0], testing::HasSubstr("pose of object arrow"));
    const StoredState now = restarted.session.stored_state();
    ASSERT_EQ(now.objects.size(), 1U);
    EXPECT_EQ(now.objects[0].object.object_id, 1U);
    EXPECT_EQ(now.objects[0].object.start.pose.t_px, Eigen::Vector2d(50, 60));
}

}  // namespace
}  // namespace pursuit::tracker
