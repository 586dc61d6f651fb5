// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow;
using test::outline_events;
using test::Poses;
using test::small_sensor;
using test::that_follows_an_arrow;

Pose gliding(double t_us) { return pose_of(100 + 8e-5 * t_us, 100 + 4e-5 * t_us, 0.3); }

std::uint64_t times_lost_by(const Tracker& tracker, LossCause cause) {
    return tracker.counters().lost_by[static_cast<std::size_t>(cause)];
}

TEST(LossCause, is_told_while_the_state_is_lost_and_never_else) {
    const auto events = outline_events(arrow(), gliding, 0, 400'000, 60, 22'000, small_sensor, 1);
    Tracker tracker = that_follows_an_arrow(gliding(0));
    Poses poses;
    tracker.process(events, poses);
    std::uint64_t changes = 0;
    LossCause before = LossCause::not_lost;
    for (const auto& row : poses.rows) {
        const LossCause cause = row.record.loss_cause;
        EXPECT_EQ(cause != LossCause::not_lost, row.record.state == TrackState::lost);
        if (cause != LossCause::not_lost && cause != before) ++changes;
        before = cause;
    }
    EXPECT_EQ(poses.rows.back().record.loss_cause, LossCause::in_noise);
    EXPECT_GE(times_lost_by(tracker, LossCause::in_noise), 1U);
    std::uint64_t counted = 0;
    for (const std::uint64_t times : tracker.counters().lost_by) counted += times;
    EXPECT_EQ(counted, changes);
}

TEST(LossCause, of_what_was_not_seen_again_in_a_new_stream_is_the_same_whatever_it_counts_from) {
    for (const std::int64_t begin_us : {std::int64_t{0}, std::int64_t{1'700'000'000'000'000}}) {
        Tracker tracker = that_follows_an_arrow(gliding(0));
        Poses poses;
        tracker.process(outline_events(arrow(), gliding, 0, 400'000, 60, 5, small_sensor, 1),
                        poses);
        tracker.begin_stream(small_sensor, 2);
        poses.rows.clear();
        const Event far_off{begin_us, 300, 230, 1};
        tracker.process({&far_off, 1}, poses);
        tracker.advance(begin_us + 900'000, poses);
        ASSERT_GT(poses.rows.size(), 890U);
        for (const auto& row : poses.rows) {
            const bool may_coast = row.record.t_us - begin_us < 790'000;
            if (may_coast) {
                EXPECT_EQ(row.record.state, TrackState::occluded) << row.record.t_us;
            }
        }
        EXPECT_EQ(poses.rows.back().record.state, TrackState::lost);
        EXPECT_EQ(poses.rows.back().record.loss_cause, LossCause::not_seen_again);
        EXPECT_EQ(times_lost_by(tracker, LossCause::not_seen_again), 1U);
    }
}

// With steps as large as parameters may be the paper's descent runs off.
TEST(LossCause, of_an_estimator_that_ran_off_is_told_and_no_pose_out_of_bounds_is) {
    for (const auto transform : {TransformKind::isometry, TransformKind::similarity,
                                 TransformKind::paper_affine, TransformKind::full_affine}) {
        Tracker tracker = Tracker::create({}).value();
        tracker.begin_stream(small_sensor, 1);
        Registration registration;
        registration.shape = arrow();
        registration.transform = transform;
        registration.estimator = EstimatorKind::gradient;
        registration.start.pose = gliding(0);
        registration.parameters = {{"gate_px", 50},
                                   {"let_go_sharpness", 0},
                                   {"gradient_position_gain", 0.5},
                                   {"gradient_angle_gain_rad_px2", 0.1},
                                   {"gradient_scale_gain_1_px", 0.1},
                                   {"gradient_affine_gain_1_px2", 0.1}};
        tracker.register_object(registration).value();
        Poses poses;
        tracker.process(outline_events(arrow(), gliding, 0, 400'000, 60, 50, small_sensor, 1),
                        poses);
        ASSERT_GT(poses.rows.size(), 390U);
        for (const auto& row : poses.rows) {
            ASSERT_TRUE(check(row.record.pose, transform)) << row.record.t_us;
            ASSERT_TRUE(check(row.record.velocity)) << row.record.t_us;
        }
        if (transform == TransformKind::full_affine) {
            EXPECT_GE(times_lost_by(tracker, LossCause::out_of_bounds), 1U);
        }
    }
}

// Lines 9 px apart go over the place where there never was an object.
TEST(LossCause, is_told_of_an_object_that_is_not_there_however_wide_its_gate) {
    for (const double gate_px : {4.0, 6.5, 20.0, 50.0}) {
        Tracker tracker = Tracker::create({}).value();
        tracker.begin_stream(small_sensor, 1);
        Registration registration;
        registration.shape = test::square();
        registration.estimator = EstimatorKind::kalman;
        registration.start.pose = pose_of(100, 120, 0);
        registration.parameters = {{"gate_px", gate_px}};
        tracker.register_object(registration).value();
        std::mt19937 random(1);
        std::vector<Event> events;
        for (std::int64_t t_us = 0; t_us < 1'000'000; t_us += 10) {
            const double x = 40 + 9.0 * static_cast<double>(random() % 14) +
                             std::fmod(1e-4 * static_cast<double>(t_us), 9);
            events.push_back({t_us, static_cast<std::uint16_t>(std::lround(x)),
                              static_cast<std::uint16_t>(60 + random() % 120),
                              static_cast<std::uint8_t>(random() % 2)});
        }
        Poses poses;
        tracker.process(events, poses);
        int confident = 0;
        for (const auto& row : poses.rows) confident += row.record.confidence > 0.5F ? 1 : 0;
        EXPECT_LE(confident, 10) << gate_px;
        EXPECT_EQ(poses.rows.back().record.state, TrackState::lost) << gate_px;
    }
}

}  // namespace
}  // namespace pursuit::tracker
