// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <fstream>

#include "tests/unit/tracker/core/calls.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow;
using test::at;
using test::make_tracker;
using test::Poses;
using test::small_sensor;
using test::status_of;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(TrackerCalls, refuse_options_out_of_range) {
    for (const TrackerOptions& bad :
         {TrackerOptions{.pose_rate_hz = 0}, TrackerOptions{.pose_rate_hz = 1e6},
          TrackerOptions{.pose_rate_hz = std::nan("")}, TrackerOptions{.max_poses_per_s = 0},
          TrackerOptions{.max_objects = 0}, TrackerOptions{.max_objects = 257},
          TrackerOptions{.next_object_id = 0}}) {
        EXPECT_EQ(status_of(Tracker::create(bad)), CallStatus::invalid_argument);
    }
    EXPECT_EQ(status_of(Tracker::create({.preset = "other"})), CallStatus::not_found);
}

TEST(TrackerCalls, let_an_object_that_no_event_has_moved_start_as_a_new_transform_allows) {
    Tracker tracker = std::move(*Tracker::create({}));
    Registration large = at(arrow("a"), 100, 90);
    large.transform = TransformKind::similarity;
    large.start.pose = pose_of(100, 90, 0, 1.2, 1.2);
    ASSERT_TRUE(tracker.register_object(large));
    ASSERT_TRUE(tracker.update_object({arrow("a"), TransformKind::isometry, large.estimator, {}}));
    tracker.begin_stream(small_sensor, 7);
    Poses poses;
    const Event elsewhere{10, 300, 1, 1};
    tracker.process(std::span(&elsewhere, 1), poses);
    tracker.advance(2'000, poses);
    ASSERT_FALSE(poses.rows.empty());
    EXPECT_EQ(poses.rows.back().record.state, TrackState::tracking);
    EXPECT_DOUBLE_EQ(poses.rows.back().record.scale_x, 1);
}

TEST(TrackerCalls, refuse_bad_shapes_starts_and_parameters_and_change_nothing) {
    Tracker tracker = make_tracker();
    Registration bad = at(arrow("a"), 1, 1);
    bad.shape.points_px[3].x() = std::nanf("");
    EXPECT_EQ(status_of(tracker.register_object(bad)), CallStatus::invalid_argument);
    bad = at(arrow("a"), std::nan(""), 1);
    EXPECT_EQ(status_of(tracker.register_object(bad)), CallStatus::invalid_argument);
    bad = at(arrow("a"), 1, 1);
    bad.start.velocity.vx_px_s = INFINITY;
    EXPECT_EQ(status_of(tracker.register_object(bad)), CallStatus::invalid_argument);
    bad = at(arrow("a"), 1, 1);
    bad.parameters = {{"gate_px", -4}};
    EXPECT_EQ(status_of(tracker.register_object(bad)), CallStatus::invalid_argument);
    bad.parameters = {{"gate", 4}};
    EXPECT_EQ(status_of(tracker.register_object(bad)), CallStatus::not_found);
    EXPECT_THAT(tracker.object_names(), ElementsAre());
    EXPECT_EQ(tracker.next_object_id(), 1U);
}

TEST(TrackerCalls, refuse_a_shape_that_leaves_its_bounds_about_its_centre) {
    Tracker tracker = make_tracker();
    Registration wide = at(arrow("a"), 1, 1);
    wide.shape.points_px.assign(100, {-4096, 0});
    wide.shape.points_px[0] = {4096, 0};
    wide.shape.edges.clear();
    const auto refused = tracker.register_object(wide);
    EXPECT_EQ(status_of(refused), CallStatus::invalid_argument);
    EXPECT_THAT(refused.error().message, HasSubstr("centre of gravity"));
}

TEST(TrackerCalls, refuse_more_objects_than_fit) {
    Tracker tracker = make_tracker({.max_objects = 2});
    ASSERT_TRUE(tracker.register_object(at(arrow("a"), 1, 1)));
    ASSERT_TRUE(tracker.register_object(at(arrow("b"), 1, 1)));
    EXPECT_EQ(status_of(tracker.register_object(at(arrow("c"), 1, 1))), CallStatus::limit_exceeded);
}

TEST(TrackerCalls, name_unknown_objects) {
    Tracker tracker = make_tracker();
    EXPECT_EQ(status_of(tracker.remove_object("x")), CallStatus::not_found);
    EXPECT_EQ(status_of(tracker.set_pose("x", {})), CallStatus::not_found);
    EXPECT_EQ(status_of(tracker.object("x")), CallStatus::not_found);
    const std::vector<NamedValue> gate{{"gate_px", 5}};
    EXPECT_EQ(status_of(tracker.set_parameters("x", gate)), CallStatus::not_found);
    EXPECT_EQ(status_of(tracker.update_object({arrow("x"), {}, {}, {}})), CallStatus::not_found);
}

TEST(TrackerCalls, set_parameters_of_one_object_of_all_and_of_the_tracker) {
    Tracker tracker = make_tracker();
    ASSERT_TRUE(tracker.register_object(at(arrow("a"), 1, 1)));
    ASSERT_TRUE(tracker.register_object(at(arrow("b"), 1, 1)));
    const std::vector<NamedValue> one{{"gate_px", 5}};
    ASSERT_TRUE(tracker.set_parameters("a", one));
    EXPECT_EQ(tracker.object("a")->parameters.gate_px, 5);
    EXPECT_NE(tracker.object("b")->parameters.gate_px, 5);
    const std::vector<NamedValue> all{{"gate_px", 8}, {"coast_s", 0.25}};
    ASSERT_TRUE(tracker.set_parameters("", all));
    EXPECT_EQ(tracker.object("a")->parameters.gate_px, 8);
    EXPECT_EQ(tracker.object("b")->parameters.gate_px, 8);
    EXPECT_EQ(tracker.settings().new_objects.gate_px, 8);
    EXPECT_EQ(tracker.settings().tracker.coast_s, 0.25);
    const std::vector<NamedValue> half_bad{{"gate_px", 9}, {"coast_s", -1}};
    EXPECT_EQ(status_of(tracker.set_parameters("", half_bad)), CallStatus::invalid_argument);
    EXPECT_EQ(tracker.object("a")->parameters.gate_px, 8);
}

TEST(TrackerCalls, update_an_object_and_keep_its_pose) {
    Tracker tracker = make_tracker();
    ASSERT_TRUE(tracker.register_object(at(arrow("a"), 30, 40)));
    ObjectUpdate update{arrow("a"), TransformKind::similarity, EstimatorKind::gradient, {}};
    for (auto& point : update.shape.points_px) point *= 1.1F;
    ASSERT_TRUE(tracker.update_object(update));
    EXPECT_EQ(tracker.object("a")->transform, TransformKind::similarity);
    Poses poses;
    const std::vector<Event> far{{0, 300, 200, 1}, {1500, 300, 200, 1}};
    tracker.process(far, poses);
    ASSERT_FALSE(poses.rows.empty());
    EXPECT_EQ(poses.rows[0].record.pose.t_px, Eigen::Vector2d(30, 40));
    EXPECT_EQ(poses.rows[0].record.transform, TransformKind::similarity);
}

TEST(TrackerCalls, hold_from_the_first_time_after_the_last_processed_one) {
    Tracker tracker = make_tracker();
    Poses poses;
    const std::vector<Event> first{{0, 300, 200, 1}, {2500, 300, 200, 1}};
    tracker.process(first, poses);
    EXPECT_EQ(tracker.effective_time_us(), 2501);
    ASSERT_TRUE(tracker.register_object(at(arrow("a"), 100, 100)));
    EXPECT_EQ(tracker.object("a")->effective_time_us, 2501);
    // More events of the same microsecond come before the call, whenever it was made.
    const std::vector<Event> same{{2500, 70, 100, 1}};
    tracker.process(same, poses);
    EXPECT_EQ(tracker.counters().events_used, 0U);
    tracker.advance(4000, poses);
    ASSERT_EQ(poses.rows.size(), 2U);
    EXPECT_EQ(poses.rows[0].record.t_us, 3000);
    EXPECT_EQ(poses.rows[0].model, "a");
    EXPECT_EQ(poses.rows[0].record.stream_id, 7U);
    ASSERT_TRUE(tracker.remove_object("a"));
    EXPECT_EQ(tracker.effective_time_us(), 4001);
    tracker.advance(9000, poses);
    EXPECT_EQ(poses.rows.size(), 2U);
}

TEST(TrackerCalls, wait_for_the_next_event_up_to_1024_and_are_refused_beyond) {
    Tracker tracker = make_tracker();
    Poses poses;
    ASSERT_TRUE(tracker.register_object(at(arrow("a"), 10, 10)));
    // Before the first event none has to wait.
    for (int i = 0; i < 2000; ++i) {
        ASSERT_TRUE(tracker.set_pose("a", {false, pose_of(20, 20, 0), {}})) << i;
    }
    tracker.process({{{1000, 100, 100, 1}}}, poses);
    for (int i = 0; i < 1024; ++i) {
        ASSERT_TRUE(tracker.set_pose("a", {false, pose_of(30, 20, 0), {}})) << i;
    }
    const Start beyond{false, pose_of(50, 50, 0), {}};
    EXPECT_EQ(status_of(tracker.set_pose("a", beyond)), CallStatus::limit_exceeded);
    EXPECT_EQ(status_of(tracker.remove_object("a")), CallStatus::limit_exceeded);
    EXPECT_EQ(tracker.object("a")->start.pose.t_px.x(), 30);
    tracker.process({{{2000, 100, 100, 1}}}, poses);
    EXPECT_EQ(poses.rows.back().record.pose.t_px.x(), 30);
    EXPECT_TRUE(tracker.set_pose("a", beyond));
}

TEST(TrackerCalls, that_set_parameters_wait_without_copies_of_the_shapes) {
    Tracker tracker = make_tracker();
    Poses poses;
    const Event event{10, 1, 1, 1};
    tracker.process(std::span(&event, 1), poses);
    for (int i = 0; i < 8; ++i) {
        const Shape ring = test::ring("r" + std::to_string(i), 50, max_shape_points);
        ASSERT_TRUE(tracker.register_object(at(ring, 100, 90)));
    }
    const std::size_t before_bytes = mallinfo2().uordblks;
    const NamedValue gate{"gate_px", 5};
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(tracker.set_parameters("", std::span(&gate, 1)));
    EXPECT_LT(mallinfo2().uordblks - before_bytes, 10'000'000U);
}

TEST(TrackerCalls, of_a_tracker_that_only_checks_are_answered_alike_and_move_nothing) {
    Tracker tracker = make_tracker({.only_checks = true});
    Poses poses;
    ASSERT_TRUE(tracker.register_object(at(arrow("a"), 10, 10)));
    EXPECT_EQ(status_of(tracker.set_pose("b", {})), CallStatus::not_found);
    EXPECT_TRUE(tracker.set_pose("a", {false, pose_of(20, 20, 0), {}}));
    EXPECT_EQ(tracker.object("a")->start.pose.t_px.x(), 20);
    tracker.process({{{1000, 100, 100, 1}, {9000, 100, 100, 1}}}, poses);
    EXPECT_TRUE(poses.rows.empty());
}

TEST(TrackerCalls, of_a_tracker_that_only_checks_need_no_memory_for_the_image_of_a_stream) {
    const auto mapped_pages = [] {
        std::size_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        return pages;
    };
    Tracker tracker = Tracker::create({.only_checks = true}).value();
    const std::size_t before = mapped_pages();
    ASSERT_GT(before, 0U);
    tracker.begin_stream({4096, 2048}, 1);  // 128 MB
    EXPECT_LT(mapped_pages(), before + (std::size_t{64} << 20) / 4096);
    EXPECT_EQ(tracker.geometry(), Geometry{});
}

TEST(TrackerCalls, drop_and_count_events_outside_the_geometry_or_back_in_time) {
    Tracker tracker = make_tracker();
    Poses poses;
    const std::vector<Event> events{{10, 304, 0, 1}, {10, 0, 240, 0},      {20, 5, 5, 1},
                                    {19, 5, 5, 1},   {-1, 5, 5, 1},        {INT64_MAX, 5, 5, 1},
                                    {20, 5, 5, 1},   {40, 65535, 65535, 1}};
    tracker.process(events, poses);
    const TrackerCounters& counters = tracker.counters();
    EXPECT_EQ(counters.events_in, 8U);
    EXPECT_EQ(counters.dropped_outside_geometry, 3U);
    EXPECT_EQ(counters.dropped_time_went_back, 1U);
    EXPECT_EQ(counters.dropped_time_out_of_range, 2U);
    EXPECT_EQ(counters.events_unused, 2U);
    EXPECT_EQ(tracker.last_t_us(), 20);
}

}  // namespace
}  // namespace pursuit::tracker
