// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "services/tracker/tracker_wire.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

/// A session over what a former run left, and what it said of that.
struct Restarted {
    explicit Restarted(const StoredState& stored = {}, int steps = 100)
        : steps_left(steps),
          session(Tracker::create({}).value(), {}, stored, {}, clock,
                  {[](v1::ObjectPose&) { return true; }, [](v1::PoseTrack&) { return true; },
                   [this](v1::RegisteredModel&) { return takes_models; },
                   [](v1::TrackerSettings&) { return true; },
                   [this](v1::RegisteredModel& model) {
                       models_forgotten.push_back(model.object_id());
                       return true;
                   },
                   [this](std::uint32_t object_id) { poses_forgotten.push_back(object_id); },
                   [](const SessionFigures&) { return v1::TrackerStatus(); },
                   [this](const std::string& message) { errors.push_back(message); },
                   [](const PoseRecord&) {}, [this] { return steps_left-- > 0; }}) {}

    /// Registers an object and removes it.
    void come_and_go() {
        Registration registration;
        registration.shape = test::arrow();
        registration.start.pose = pose_of(100, 90, 0);
        v1::TrackerRequest request;
        request.call().register_model(register_model(registration));
        EXPECT_EQ(session.answer(request).outcome().code(), v1::STATUS_OK);
        v1::ModelName name;
        name.name(registration.shape.name);
        request.call().remove_model(name);
        EXPECT_EQ(session.answer(request).outcome().code(), v1::STATUS_OK);
    }
    void packet_at(std::int64_t t_us) {
        v1::EventPacket packet;
        packet.stream_id(8);
        packet.sequence_number(++packets);
        packet.base_time_us(t_us);
        packet.width(304);
        packet.height(240);
        session.take(packet);
    }

    int steps_left;
    ManualClock clock;
    bool takes_models = true;
    std::uint64_t packets = 0;
    std::vector<std::uint32_t> models_forgotten;
    std::vector<std::uint32_t> poses_forgotten;
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

TEST(TrackerSession, lets_the_middleware_forget_removed_models_but_for_the_last_16) {
    Restarted restarted;
    for (int i = 0; i < 20; ++i) restarted.come_and_go();
    EXPECT_THAT(restarted.models_forgotten, testing::ElementsAre(1, 2, 3, 4));
}

TEST(TrackerSession, lets_the_middleware_forget_poses_once_events_have_gone_past_the_removal) {
    Restarted restarted;
    restarted.packet_at(1'000);
    restarted.come_and_go();
    restarted.come_and_go();
    restarted.packet_at(1'000);
    EXPECT_TRUE(restarted.poses_forgotten.empty()) << "poses before the removal may still come";
    restarted.packet_at(2'000);
    EXPECT_THAT(restarted.poses_forgotten, testing::ElementsAre(1, 2));
}

TEST(TrackerSession, stores_at_once_that_an_id_was_given_to_a_call_that_waits) {
    Restarted restarted;
    v1::TrackerRequest request;
    Registration registration;
    registration.shape = test::arrow();
    registration.start.pose = pose_of(100, 90, 0);
    request.call().register_model(register_model(registration));
    request.apply_at_us(1'000);
    const auto revision = restarted.session.revision();
    EXPECT_EQ(restarted.session.answer(request).outcome().code(), v1::STATUS_OK);
    EXPECT_EQ(restarted.session.figures().calls_waiting, 1U);
    EXPECT_NE(restarted.session.revision(), revision);
    EXPECT_EQ(restarted.session.stored_state().next_object_id, 2U);
}

TEST(TrackerSession, gives_up_between_two_objects_where_the_start_may_not_go_on) {
    StoredState stored = tracked_at(pose_of(100, 90, 1));
    stored.objects.push_back(stored.objects[0]);
    stored.objects[1].object.object_id = 2;
    stored.objects[1].object.shape.name = "second";
    stored.next_object_id = 3;
    EXPECT_TRUE(Restarted(stored).session.is_whole());
    Restarted restarted(stored, 1);
    EXPECT_FALSE(restarted.session.is_whole());
    EXPECT_EQ(restarted.session.stored_state().objects.size(), 1U);
    EXPECT_TRUE(restarted.errors.empty());
}

TEST(TrackerSession, tells_of_samples_that_were_not_taken_at_most_once_in_10_s) {
    Restarted restarted;
    restarted.takes_models = false;
    restarted.come_and_go();
    ASSERT_EQ(restarted.errors.size(), 1U);
    EXPECT_THAT(restarted.errors[0], testing::HasSubstr("did not take 1 samples"));
    restarted.clock.advance(9'999'999'999);
    restarted.come_and_go();
    EXPECT_EQ(restarted.errors.size(), 1U);
    restarted.clock.advance(1);
    restarted.come_and_go();
    ASSERT_EQ(restarted.errors.size(), 2U);
    EXPECT_THAT(restarted.errors[1], testing::HasSubstr("did not take 5 samples"));
}

}  // namespace
}  // namespace pursuit::tracker
