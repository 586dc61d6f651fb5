// SPDX-License-Identifier: Apache-2.0
// What a former run followed, in the stream that begins next.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/tracker/core/geometry/coast.hpp"
#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow;
using test::Poses;
using test::small_sensor;
using testing::HasSubstr;

constexpr std::uint64_t stream_id = 7;
constexpr std::int64_t killed_us = 1'000'000;
constexpr std::int64_t back_us = 1'200'000;
constexpr std::int64_t end_us = 1'400'000;

const Pose registered = pose_of(60, 200, 0);

/// At the kill.
const Coast last_seen{
    killed_us, pose_of(90, 110, 0.4), {.vx_px_s = 200, .vy_px_s = 0, .omega_rad_s = 1}};

/// On round the bend that it was in.
Pose truth(double t_us) { return last_seen.at(static_cast<std::int64_t>(t_us), 60).pose; }

std::vector<Event> events(double noise_hz = 0.5, double per_ms = test::arrow_per_ms) {
    return test::outline_events(arrow(), truth, back_us, end_us, per_ms,
                                test::noise_per_ms(noise_hz), small_sensor, 3);
}

/// Where an arrow was followed until the kill.
TrackSnapshot followed_in(TrackState state) {
    return {.object_id = 1,
            .state = state,
            .was_tracked = true,
            .t_us = killed_us,
            .pose = last_seen.pose,
            .velocity = last_seen.velocity};
}

Tracker restarted(const TrackSnapshot& last, const Start& start = {false, registered, {}}) {
    Tracker tracker = Tracker::create({.next_object_id = 2}).value();
    Registration registration;
    registration.object_id = 1;
    registration.shape = arrow();
    registration.estimator = EstimatorKind::kalman;
    registration.start = start;
    tracker.register_object(registration).value();
    EXPECT_TRUE(tracker.resume(last, stream_id));
    return tracker;
}

/// The poses of the stream that begins when the tracker is back.
std::vector<PoseRecord> poses_of(Tracker& tracker, std::uint64_t id,
                                 const std::vector<Event>& events,
                                 std::int64_t first_t_us = back_us) {
    Poses poses;
    tracker.begin_stream(small_sensor, id, first_t_us);
    tracker.process(events, poses);
    tracker.advance(end_us, poses);
    std::vector<PoseRecord> records;
    for (const auto& row : poses.rows) records.push_back(row.record);
    EXPECT_GT(records.size(), 100U);
    return records;
}

double error_px(const PoseRecord& record) {
    return test::rms_px(arrow(), record.pose, truth(static_cast<double>(record.t_us)));
}

TEST(Resume, goes_on_in_the_same_stream_from_where_the_object_is_by_now) {
    Tracker tracker = restarted(followed_in(TrackState::tracking));
    const auto records = poses_of(tracker, stream_id, events());
    for (const auto& record : records) {
        EXPECT_EQ(record.state, TrackState::tracking) << record.t_us;
        EXPECT_LT(error_px(record), 2) << record.t_us;
    }
    EXPECT_GT(records.back().confidence, 0.5);
}

TEST(Resume, moves_a_pose_on_by_two_seconds_at_most) {
    Tracker tracker = restarted(followed_in(TrackState::tracking));
    Poses poses;
    const std::int64_t late_us = killed_us + 60'000'000;
    tracker.begin_stream(small_sensor, stream_id, late_us);
    const Event event{late_us, 300, 1, 1};
    tracker.process(std::span(&event, 1), poses);
    tracker.advance(late_us + 1'000, poses);
    ASSERT_FALSE(poses.rows.empty());
    const Pose moved = poses.rows.front().record.pose;
    EXPECT_LT((moved.t_px - last_seen.pose.t_px).norm(), 401);
}

TEST(Resume, looks_for_the_object_in_another_stream_and_tells_no_pose_of_it_before) {
    Tracker tracker = restarted(followed_in(TrackState::tracking));
    const auto records = poses_of(tracker, stream_id + 1, events());
    EXPECT_EQ(records.front().state, TrackState::occluded);
    for (const auto& record : records) {
        if (record.state != TrackState::tracking) continue;
        EXPECT_LT(error_px(record), 4) << record.t_us;
    }
    EXPECT_EQ(records.back().state, TrackState::tracking);
}

TEST(Resume, takes_a_stream_that_is_played_from_before_for_another) {
    Tracker tracker = restarted(followed_in(TrackState::tracking));
    EXPECT_EQ(poses_of(tracker, stream_id, events(), killed_us - 1).front().state,
              TrackState::occluded);
}

TEST(Resume, keeps_lost_what_was_lost_until_it_is_found) {
    for (const double per_ms : {0.0, test::arrow_per_ms}) {
        Tracker tracker = restarted(followed_in(TrackState::lost));
        const auto records = poses_of(tracker, stream_id, events(5, per_ms));
        EXPECT_EQ(records.front().state, TrackState::lost);
        EXPECT_EQ(records.front().confidence, 0);
        EXPECT_EQ(records.back().state, per_ms > 0 ? TrackState::tracking : TrackState::lost);
    }
}

TEST(Resume, lets_go_on_being_occluded_what_was_occluded) {
    Tracker tracker = restarted(followed_in(TrackState::occluded));
    const auto records = poses_of(tracker, stream_id, events(5, 0));
    EXPECT_EQ(records.front().state, TrackState::occluded);
    EXPECT_LT(error_px(records.front()), 1);
    EXPECT_NE(records.back().state, TrackState::tracking);
}

TEST(Resume, leaves_where_the_object_is_registered_to_start_as_it_is) {
    for (const Start& start : {Start{false, registered, {}}, Start{true, {}, {}}}) {
        Tracker tracker = restarted(followed_in(TrackState::tracking), start);
        EXPECT_EQ(tracker.object("arrow")->start, start);
        EXPECT_LT(error_px(poses_of(tracker, stream_id, events()).front()), 2);
        EXPECT_EQ(tracker.object("arrow")->start, start);
    }
}

TEST(Resume, gives_way_to_a_pose_that_is_set_before_the_stream_begins) {
    Tracker tracker = restarted(followed_in(TrackState::tracking));
    ASSERT_TRUE(tracker.set_pose("arrow", {false, registered, {}}));
    EXPECT_FALSE(tracker.snapshots().front().was_tracked);
    EXPECT_EQ(poses_of(tracker, stream_id, events()).front().pose.t_px, registered.t_px);
}

TEST(Resume, keeps_what_was_known_for_a_further_run_until_an_event_has_told_more) {
    const TrackSnapshot last = followed_in(TrackState::tracking);
    Tracker tracker = restarted(last);
    const auto expect_kept = [&] {
        const TrackSnapshot now = tracker.snapshots().front();
        EXPECT_TRUE(now.was_tracked);
        EXPECT_EQ(now.state, TrackState::tracking);
        EXPECT_EQ(now.t_us, last.t_us);
        EXPECT_EQ(now.pose, last.pose);
    };
    expect_kept();
    poses_of(tracker, stream_id, {{back_us, 300, 1, 1}});
    expect_kept();
    // In another stream it is not followed, and still the last that is known.
    tracker.begin_stream(small_sensor, stream_id + 1, 5);
    const TrackSnapshot now = tracker.snapshots().front();
    EXPECT_TRUE(now.was_tracked);
    EXPECT_EQ(now.state, TrackState::occluded);
    EXPECT_EQ(now.pose, last.pose);
}

/// Follows the arrow until it is killed, and hears of no event after.
Tracker followed_until_the_kill() {
    Tracker tracker = test::that_follows_an_arrow(truth(killed_us - 200'000));
    tracker.begin_stream(small_sensor, stream_id);
    Poses poses;
    tracker.process(test::outline_events(arrow(), truth, killed_us - 200'000, killed_us,
                                         test::arrow_per_ms, 0, small_sensor, 3),
                    poses);
    EXPECT_EQ(tracker.snapshots().front().state, TrackState::tracking);
    EXPECT_LT(test::rms_px(arrow(), tracker.snapshots().front().pose, last_seen.pose), 2);
    return tracker;
}

TEST(Resume, goes_on_from_where_a_pose_was_set_as_long_after_the_last_event_as_that_was) {
    Tracker tracker = followed_until_the_kill();
    Poses poses;
    const std::int64_t set_us = killed_us + 60'000'000;
    tracker.advance(set_us - 1, poses);
    const Start set{false, pose_of(200, 60, 0), {.vx_px_s = 50}};
    ASSERT_TRUE(tracker.set_pose("arrow", set));
    tracker.advance(set_us + 10'000, poses);
    const TrackSnapshot last = tracker.snapshots().front();
    EXPECT_EQ(last.t_us, set_us);
    EXPECT_EQ(last.pose.t_px, set.pose.t_px);
    Tracker again = restarted(last);
    again.begin_stream(small_sensor, stream_id, set_us + 20'000);
    const Event event{set_us + 20'000, 5, 5, 1};
    Poses resumed;
    again.process({&event, 1}, resumed);
    again.advance(set_us + 21'000, resumed);
    ASSERT_FALSE(resumed.rows.empty());
    EXPECT_EQ(resumed.rows.back().record.state, TrackState::tracking);
    EXPECT_NEAR(resumed.rows.back().record.pose.t_px.x(), 201, 0.1);
}

TEST(Resume, takes_a_pose_that_was_set_for_a_stream_to_be_of_its_first_time) {
    Tracker tracker = followed_until_the_kill();
    ASSERT_TRUE(tracker.set_pose("arrow", {false, registered, {.vx_px_s = 50}}));
    tracker.begin_stream(small_sensor, stream_id + 1, back_us);
    const TrackSnapshot last = tracker.snapshots().front();
    EXPECT_EQ(last.t_us, back_us);
    EXPECT_EQ(last.pose, registered);
}

TEST(Resume, is_refused_for_no_object_and_for_no_pose) {
    TrackSnapshot last = followed_in(TrackState::tracking);
    Tracker tracker = restarted(last);
    last.object_id = 2;
    EXPECT_EQ(tracker.resume(last, stream_id).error().status, CallStatus::not_found);
    last = followed_in(TrackState::tracking);
    last.pose.t_px.x() = std::nan("");
    EXPECT_THAT(tracker.resume(last, stream_id).error().message, HasSubstr("last."));
    last = followed_in(TrackState::tracking);
    last.velocity.omega_rad_s = INFINITY;
    EXPECT_EQ(tracker.resume(last, stream_id).error().status, CallStatus::invalid_argument);
}

}  // namespace
}  // namespace pursuit::tracker
