// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "services/sensor/packed_event.hpp"
#include "services/tracker/tracker_wire.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

/// A session over what a former run left, and what it said of that.
struct Restarted {
    explicit Restarted(const StoredState& stored = {}, const std::vector<Registration>& models = {},
                       int steps = 100)
        : steps_left(steps),
          session(Tracker::create({}).value(), {}, stored, models, clock,
                  {[this](v1::ObjectPose&) { return takes; }, [](v1::PoseTrack&) { return true; },
                   [this](v1::RegisteredModel&) { return takes && takes_models; },
                   [this](v1::TrackerSettings&) { return takes; },
                   [this](v1::RegisteredModel& model) {
                       models_forgotten.push_back(model.object_id());
                       return true;
                   },
                   [this](std::uint32_t object_id) { poses_forgotten.push_back(object_id); },
                   [](const SessionFigures&) { return v1::TrackerStatus(); },
                   [this](const std::string& message) { errors.push_back(message); },
                   [](const PoseRecord&) {},
                   [this](const std::string& message) { remarks.push_back(message); },
                   [this] { return steps_left-- > 0; }}) {}

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
    pursuit::test::ManualClock clock;
    bool takes_models = true;
    std::uint64_t packets = 0;
    std::vector<std::uint32_t> models_forgotten;
    std::vector<std::uint32_t> poses_forgotten;
    std::vector<std::string> errors;
    std::vector<std::string> remarks;
    bool takes = true;  ///< Whether the middleware takes what is written.
    TrackerSession session;
};

/// The packet of that number of stream 8, empty, of an image 240 px high.
v1::EventPacket packet_at(std::uint64_t number, std::int64_t base_time_us,
                          std::uint16_t width_px = 304) {
    v1::EventPacket packet;
    packet.sensor_id(1);
    packet.stream_id(8);
    packet.sequence_number(number);
    packet.base_time_us(base_time_us);
    packet.width(width_px);
    packet.height(240);
    return packet;
}

v1::TrackerRequest to_set_the_pose_of_the_arrow(std::int64_t apply_at_us) {
    v1::SetPose set;
    set.name("arrow");
    set.pose(start_pose({.search = false, .pose = pose_of(60, 60, 1), .velocity = {}}));
    v1::TrackerRequest request;
    request.apply_at_us(apply_at_us);
    request.call().set_pose(set);
    return request;
}

v1::TrackerRequest to_remove_the_arrow() {
    v1::ModelName model;
    model.name("arrow");
    v1::TrackerRequest request;
    request.call().remove_model(model);
    return request;
}

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

TEST(TrackerSession, says_where_the_store_holds_something_else_than_the_configuration) {
    StoredState stored = tracked_at(pose_of(100, 90, 1));
    stored.objects[0].object.parameters = Tracker::create({}).value().settings().new_objects;
    Registration arrow;
    arrow.shape = test::arrow();
    arrow.start.pose = pose_of(50, 60, 0.5);
    EXPECT_TRUE(Restarted(stored, {arrow}).remarks.empty());
    arrow.start.pose = pose_of(51, 60, 0.5);
    stored.settings.parameters = {{"gate_px", 0.5}};
    const Restarted restarted(stored, {arrow});
    ASSERT_EQ(restarted.remarks.size(), 2U);
    EXPECT_THAT(restarted.remarks[0], testing::HasSubstr("gate_px 0.5 instead of "));
    EXPECT_THAT(restarted.remarks[1], testing::HasSubstr("model arrow is as the store has it"));
    EXPECT_THAT(restarted.remarks[1], testing::HasSubstr("start"));
}

TEST(TrackerSession, has_nothing_new_to_store_before_the_first_packet) {
    StoredState stored = tracked_at(pose_of(100, 90, 1));
    stored.moment = {7, 1'000'000};
    Restarted restarted(stored);
    EXPECT_EQ(restarted.session.stored_moment(), stored.moment);
    EXPECT_EQ(restarted.session.stored_state().moment, stored.moment);
    auto packet = packet_at(0, 500);
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

TEST(TrackerSession, counts_the_events_in_packets_of_another_geometry) {
    Restarted restarted(tracked_at(pose_of(100, 90, 1)));
    auto first = packet_at(0, 500);
    restarted.session.take(first);
    auto wider = packet_at(1, 600, 640);
    wider.words({1, 2, 3});
    restarted.session.take(wider);
    const auto figures = restarted.session.figures();
    EXPECT_EQ(figures.dropped_bad_geometry, 3U);
    EXPECT_EQ(figures.stream.bad_geometry, 1U);
    EXPECT_EQ(figures.tracker.events_in, 0U);
}

TEST(TrackerSession, counts_and_tells_of_a_call_that_is_refused_after_it_waited) {
    Restarted restarted(tracked_at(pose_of(100, 90, 1)));
    auto first = packet_at(0, 500);
    restarted.session.take(first);
    auto set_pose = to_set_the_pose_of_the_arrow(2000);
    EXPECT_EQ(restarted.session.answer(set_pose).outcome().code(), v1::STATUS_OK);
    auto remove = to_remove_the_arrow();
    EXPECT_EQ(restarted.session.answer(remove).outcome().code(), v1::STATUS_OK);
    EXPECT_EQ(restarted.session.figures().late_refusals, 0U);
    auto second = packet_at(1, 3000);
    restarted.session.take(second);
    const auto figures = restarted.session.figures();
    EXPECT_EQ(figures.late_refusals, 1U);
    EXPECT_EQ(figures.calls_waiting, 0U);
    // It was accepted: its sender has that answer.
    EXPECT_EQ(figures.requests, 2U);
    EXPECT_EQ(figures.requests_refused, 0U);
    ASSERT_EQ(restarted.errors.size(), 1U);
    EXPECT_THAT(restarted.errors[0], testing::HasSubstr("arrow"));
}

TEST(TrackerSession, counts_a_call_that_is_refused_at_once_as_no_late_one) {
    Restarted restarted(tracked_at(pose_of(100, 90, 1)));
    auto remove = to_remove_the_arrow();
    EXPECT_EQ(restarted.session.answer(remove).outcome().code(), v1::STATUS_OK);
    EXPECT_EQ(restarted.session.answer(remove).outcome().code(), v1::STATUS_NOT_FOUND);
    const auto figures = restarted.session.figures();
    EXPECT_EQ(figures.requests, 2U);
    EXPECT_EQ(figures.requests_refused, 1U);
    EXPECT_EQ(figures.late_refusals, 0U);
}

TEST(TrackerSession, counts_models_and_poses_that_could_not_be_written_together) {
    Restarted restarted(tracked_at(pose_of(100, 90, 1)));
    EXPECT_EQ(restarted.session.figures().write_failures, 0U);
    auto first = packet_at(0, 0);
    first.words({sensor::pack({0, 1, 1, 1}, 0)});
    restarted.session.take(first);
    const auto poses_before = restarted.session.figures().poses_out;
    restarted.takes = false;
    auto second = packet_at(1, 10'000);
    restarted.session.take(second);
    const auto poses_failed = restarted.session.figures().write_failures;
    EXPECT_GT(poses_failed, 0U);
    EXPECT_EQ(restarted.session.figures().poses_out, poses_before);
    auto remove = to_remove_the_arrow();
    EXPECT_EQ(restarted.session.answer(remove).outcome().code(), v1::STATUS_OK);
    EXPECT_EQ(restarted.session.figures().write_failures, poses_failed + 1);
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
    Restarted restarted(stored, {}, 1);
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
