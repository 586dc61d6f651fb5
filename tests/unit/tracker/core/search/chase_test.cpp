// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/search/chase.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::small_sensor;

Event at(std::int64_t t_us) { return {t_us, 5, 7, 1}; }

TEST(Chase, goes_through_every_event_since_then_in_order_and_catches_up_with_those_that_come) {
    LastEvents last;
    for (std::int64_t t_us = 0; t_us < 2'000; ++t_us) last.see(at(t_us));
    Chase chase;
    chase.begin(last, 500);
    EXPECT_TRUE(chase.is_complete());
    std::vector<std::int64_t> followed_us;
    std::int64_t t_us = 2'000;
    for (; !chase.is_caught_up(); ++t_us) {
        chase.see(at(t_us));
        chase.go_on([&](const Event& event) { followed_us.push_back(event.t_us); });
        ASSERT_LT(t_us, 4'000);
    }
    ASSERT_EQ(followed_us.size(), static_cast<std::size_t>(t_us - 500));
    for (std::size_t i = 0; i < followed_us.size(); ++i) {
        ASSERT_EQ(followed_us[i], 500 + static_cast<std::int64_t>(i));
    }
    chase.stop();
    EXPECT_FALSE(chase.is_complete());
}

TEST(Chase, is_not_complete_where_more_came_than_it_keeps) {
    LastEvents last;
    Chase chase;
    chase.begin(last, 0);
    for (std::size_t i = 0; i < Chase::most; ++i) chase.see(at(static_cast<std::int64_t>(i)));
    EXPECT_TRUE(chase.is_complete());
    chase.see(at(Chase::most));
    EXPECT_FALSE(chase.is_complete());
    std::size_t followed = 0;
    while (!chase.is_caught_up()) chase.go_on([&](const Event&) { ++followed; });
    EXPECT_EQ(followed, Chase::most);
    chase.begin(last, 0);
    EXPECT_TRUE(chase.is_complete());
    EXPECT_TRUE(chase.is_caught_up());
}

// On a disc that turns 20 times a second: while the image is searched it goes half round, and more.
Pose orbiting(double t_us) {
    const double angle_rad = 130e-6 * t_us;
    return pose_of(152 + 30 * std::cos(angle_rad), 120 + 30 * std::sin(angle_rad), angle_rad + 1);
}

Registration searched_arrow() {
    Registration registration;
    registration.shape = test::arrow();
    registration.start.search = true;
    return registration;
}

void expect_followed(const test::Poses& poses) {
    const PoseRecord& last = poses.rows.back().record;
    const auto t_us = static_cast<double>(last.t_us);
    EXPECT_EQ(last.state, TrackState::tracking) << t_us;
    EXPECT_LT(test::rms_px(test::arrow(), last.pose, orbiting(t_us)), 1.5) << t_us;
}

TEST(Search, finds_a_shape_that_has_gone_on_when_it_ends) {
    Tracker tracker = Tracker::create({}).value();
    tracker.begin_stream(small_sensor, 1);
    tracker.register_object(searched_arrow()).value();
    test::Poses poses;
    tracker.process(
        test::outline_events(test::arrow(), orbiting, 0, 200'000, 400, 5, small_sensor, 1), poses);
    expect_followed(poses);
}

TEST(Search, may_be_cut_off_at_any_time_by_a_call_or_a_new_stream) {
    const auto before =
        test::outline_events(test::arrow(), orbiting, 0, 160'000, 400, 5, small_sensor, 1);
    for (std::int64_t end_us = 4'000; end_us < 160'000; end_us += 4'000) {
        SCOPED_TRACE(end_us);
        Tracker tracker = Tracker::create({}).value();
        tracker.begin_stream(small_sensor, 1);
        tracker.register_object(searched_arrow()).value();
        std::vector<Event> some;
        for (const Event& event : before) {
            if (event.t_us < end_us) some.push_back(event);
        }
        test::Poses poses;
        tracker.process(some, poses);
        const Registration other = searched_arrow();
        std::int64_t next_us = end_us;
        switch (end_us / 4'000 % 4) {
            case 0:
                ASSERT_TRUE(tracker.set_pose("arrow", other.start));
                break;
            case 1:
                ASSERT_TRUE(tracker.update_object(
                    {other.shape, TransformKind::similarity, other.estimator, {}}));
                break;
            case 2:
                ASSERT_TRUE(tracker.remove_object("arrow"));
                tracker.register_object(other).value();
                break;
            default:
                tracker.begin_stream(small_sensor, 2);
                next_us = 0;
        }
        const auto to_us = next_us + 200'000;
        tracker.process(
            test::outline_events(test::arrow(), orbiting, next_us, to_us, 400, 5, small_sensor, 2),
            poses);
        expect_followed(poses);
    }
}

}  // namespace
}  // namespace pursuit::tracker
