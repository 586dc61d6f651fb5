// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow;
using test::outline_events;
using test::Poses;
using test::small_sensor;

Registration at(const std::string& name, double x_px, double y_px) {
    Registration registration;
    registration.shape = arrow(name);
    registration.start.pose = pose_of(x_px, y_px, 0);
    return registration;
}

std::vector<Event> moving_arrow(std::uint32_t seed) {
    return outline_events(
        arrow(), [](double t_us) { return pose_of(100 + 2e-4 * t_us, 100, 0); }, 3'210, 100'000, 20,
        5, small_sensor, seed);
}

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

void expect_same(const Poses& a, const Poses& b) {
    ASSERT_EQ(a.rows.size(), b.rows.size());
    for (std::size_t i = 0; i < a.rows.size(); ++i) {
        const PoseRecord& l = a.rows[i].record;
        const PoseRecord& r = b.rows[i].record;
        ASSERT_EQ(l.object_id, r.object_id);
        ASSERT_EQ(l.t_us, r.t_us);
        ASSERT_EQ(l.last_event_t_us, r.last_event_t_us);
        ASSERT_EQ(l.state, r.state);
        ASSERT_EQ(l.events_used, r.events_used);
        ASSERT_EQ(0, std::memcmp(&l.pose, &r.pose, sizeof l.pose));
        ASSERT_EQ(0, std::memcmp(&l.velocity, &r.velocity, sizeof l.velocity));
        ASSERT_EQ(0, std::memcmp(&l.pose_covariance, &r.pose_covariance, sizeof l.pose_covariance));
        ASSERT_EQ(bits(l.confidence), bits(r.confidence));
        ASSERT_EQ(bits(l.mean_residual_px), bits(r.mean_residual_px));
        ASSERT_EQ(bits(l.event_rate_hz), bits(r.event_rate_hz));
    }
}

TEST(TrackerGrid, lies_on_multiples_of_the_period_after_the_first_event) {
    Tracker tracker = std::move(*Tracker::create({}));
    tracker.begin_stream(small_sensor, 1);
    ASSERT_TRUE(tracker.register_object(at("a", 100, 100)));
    Poses poses;
    tracker.advance(2000, poses);
    EXPECT_TRUE(poses.rows.empty());
    const std::vector<Event> events{{3210, 0, 0, 1}, {5000, 0, 0, 1}, {5999, 0, 0, 1}};
    tracker.process(events, poses);
    tracker.advance(7000, poses);
    ASSERT_EQ(poses.rows.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(poses.rows[i].record.t_us, 4000 + 1000 * static_cast<std::int64_t>(i));
    }
}

TEST(TrackerGrid, holds_the_state_after_the_last_event_before_its_time) {
    Tracker tracker = std::move(*Tracker::create({}));
    tracker.begin_stream(small_sensor, 1);
    ASSERT_TRUE(tracker.register_object(at("a", 100, 100)));
    const Shape shape = arrow();
    const auto x = static_cast<std::uint16_t>(std::lround(100 + shape.points_px[0].x()));
    const auto y = static_cast<std::uint16_t>(std::lround(100 + shape.points_px[0].y()));
    Poses poses;
    const std::vector<Event> events{
        {100, x, y, 1}, {999, x, y, 1}, {1000, x, y, 1}, {1001, x, y, 1}, {2000, x, y, 1}};
    tracker.process(events, poses);
    ASSERT_EQ(poses.rows.size(), 2U);
    EXPECT_EQ(poses.rows[0].record.last_event_t_us, 999);
    EXPECT_EQ(poses.rows[0].record.events_used, 2U);
    EXPECT_EQ(poses.rows[1].record.last_event_t_us, 1001);
    EXPECT_EQ(poses.rows[1].record.events_used, 4U);
}

TEST(TrackerGrid, is_the_same_bit_for_bit_however_the_events_are_cut) {
    const std::vector<Event> events = moving_arrow(5);
    ASSERT_GT(events.size(), 500U);
    const auto run = [&](std::uint32_t seed) {
        Tracker tracker = std::move(*Tracker::create({}));
        tracker.begin_stream(small_sensor, 1);
        EXPECT_TRUE(tracker.register_object(at("a", 101, 99)));
        EXPECT_TRUE(tracker.register_object(at("b", 140, 110)));
        Poses poses;
        std::mt19937 random(seed);
        std::size_t done = 0;
        while (done < events.size()) {
            const std::size_t left = events.size() - done;
            const std::size_t count = seed == 0 ? left : std::min<std::size_t>(left, random() % 60);
            tracker.process(std::span(events).subspan(done, count), poses);
            done += count;
            if (seed != 0 && done < events.size() && random() % 2 == 0) {
                const std::int64_t now_us = tracker.last_t_us();
                const std::int64_t silence_us = events[done].t_us - now_us;
                if (silence_us > 0) tracker.advance(now_us + random() % (silence_us + 1), poses);
            }
        }
        tracker.advance(150'000, poses);
        return poses;
    };
    const Poses whole = run(0);
    EXPECT_EQ(whole.rows.size(), 2U * 147U);
    for (std::uint32_t seed = 1; seed < 12; ++seed) expect_same(whole, run(seed));
}

TEST(TrackerGrid, is_thinned_evenly_beyond_the_cap_and_counts_what_is_left_out) {
    Tracker tracker = std::move(*Tracker::create({.max_poses_per_s = 1500}));
    tracker.begin_stream(small_sensor, 1);
    for (const char* name : {"a", "b", "c", "d"}) {
        ASSERT_TRUE(tracker.register_object(at(name, 100, 100)));
    }
    Poses poses;
    std::vector<Event> events;
    for (std::int64_t t_us = 0; t_us <= 1'000'000; t_us += 500) events.push_back({t_us, 1, 1, 1});
    tracker.process(events, poses);
    std::array<int, 5> count{};
    std::array<std::int64_t, 5> last_us{};
    for (const auto& row : poses.rows) {
        const std::uint32_t id = row.record.object_id;
        if (count.at(id)++ > 0) {
            const std::int64_t spacing_us = row.record.t_us - last_us.at(id);
            EXPECT_GE(spacing_us, 2000);
            EXPECT_LE(spacing_us, 3000);
        }
        last_us.at(id) = row.record.t_us;
    }
    for (std::size_t id = 1; id < 5; ++id) EXPECT_NEAR(count.at(id), 375, 1);
    EXPECT_EQ(tracker.counters().poses_emitted, poses.rows.size());
    EXPECT_EQ(tracker.counters().poses_emitted + tracker.counters().poses_thinned, 4000U);
}

TEST(TrackerGrid, keeps_a_burst_bounded_when_time_jumps_by_hours_or_years) {
    for (const std::int64_t jump_us : {std::int64_t{7'200'000'000}, std::int64_t{1} << 52}) {
        Tracker tracker = std::move(*Tracker::create({}));
        tracker.begin_stream(small_sensor, 1);
        ASSERT_TRUE(tracker.register_object(at("a", 100, 100)));
        Poses poses;
        const std::vector<Event> before{{0, 1, 1, 1}};
        tracker.process(before, poses);
        tracker.advance(jump_us, poses);
        EXPECT_EQ(poses.rows.size(), 1000U + 590U + 3540U);
        const std::vector<Event> after{{jump_us + 5, 1, 1, 1}, {jump_us + 2000, 1, 1, 1}};
        tracker.process(after, poses);
        EXPECT_GE(poses.rows.back().record.t_us, jump_us + 1);
    }
}

TEST(TrackerGrid, begins_anew_with_a_new_stream_and_keeps_the_poses) {
    Tracker tracker = std::move(*Tracker::create({}));
    tracker.begin_stream(small_sensor, 1);
    ASSERT_TRUE(tracker.register_object(at("a", 100, 100)));
    Poses poses;
    tracker.process(moving_arrow(3), poses);
    const Eigen::Vector2d last_px = poses.rows.back().record.pose.t_px;
    tracker.begin_stream(small_sensor, 2);
    EXPECT_EQ(tracker.last_t_us(), -1);
    Poses again;
    const std::vector<Event> events{{10, 0, 0, 1}, {1000, 0, 0, 1}};
    tracker.process(events, again);
    ASSERT_EQ(again.rows.size(), 1U);
    EXPECT_EQ(again.rows[0].record.stream_id, 2U);
    EXPECT_LT((again.rows[0].record.pose.t_px - last_px).norm(), 3);
}

TEST(TrackerGrid, hands_over_every_step_where_wanted) {
    Tracker tracker = std::move(*Tracker::create({.emit_updates = true}));
    tracker.begin_stream(small_sensor, 1);
    ASSERT_TRUE(tracker.register_object(at("a", 100, 100)));
    Poses poses;
    tracker.process(moving_arrow(3), poses);
    EXPECT_EQ(poses.updates.size(), tracker.counters().events_used);
    EXPECT_GT(poses.updates.size(), 100U);
}

}  // namespace
}  // namespace pursuit::tracker
