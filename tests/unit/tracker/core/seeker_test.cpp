// SPDX-License-Identifier: Apache-2.0
// A search that goes on while its object is set elsewhere or becomes another.
#include "services/tracker/core/seeker.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow;
using test::Poses;
using test::small_sensor;

/// An arrow that is registered beside where it is: a check finds it and moves it there.
class CheckedArrow : public ::testing::Test {
 protected:
    CheckedArrow() {
        tracker_ = follower();
        Eigen::Vector2d before_px = start.t_px;
        for (const Event& event : events_) {
            tracker_.process({&event, 1}, poses_);
            const Eigen::Vector2d now_px = tracker_.snapshots().front().pose.t_px;
            if ((now_px - before_px).norm() > 5) break;
            before_px = now_px;
            ++ends_with_;
        }
    }
    void SetUp() override { ASSERT_LT(ends_with_, events_.size()) << "no check moved it"; }

    static Tracker follower() { return test::that_follows_an_arrow(start); }
    /// Up to before the event with which the check ends, and what it finds moves the object.
    void follow_until_the_check_ends() {
        tracker_ = follower();
        tracker_.process(std::span(events_).first(ends_with_), poses_);
    }
    Eigen::Vector2d place_after_the_next_event_px() {
        tracker_.process(std::span(events_).subspan(ends_with_, 1), poses_);
        return tracker_.snapshots().front().pose.t_px;
    }

    static Pose truth(double t_us) { return pose_of(100 + 3e-4 * t_us, 100 + 1e-4 * t_us, 0.3); }
    static inline const Pose start = pose_of(110, 92, 0.3);

    const std::vector<Event> events_ =
        test::outline_events(arrow(), truth, 0, 100'000, test::arrow_per_ms, 5, small_sensor, 1);
    std::size_t ends_with_ = 0;
    Tracker tracker_ = follower();
    Poses poses_;
};

TEST_F(CheckedArrow, is_moved_by_the_check) {
    follow_until_the_check_ends();
    const Eigen::Vector2d before_px = tracker_.snapshots().front().pose.t_px;
    EXPECT_GT((place_after_the_next_event_px() - before_px).norm(), 5);
}

TEST_F(CheckedArrow, stays_where_it_is_set_while_a_check_of_the_old_place_goes_on) {
    follow_until_the_check_ends();
    const Pose elsewhere = pose_of(230, 190, 0);
    ASSERT_TRUE(tracker_.set_pose("arrow", {false, elsewhere, {}}));
    EXPECT_EQ(place_after_the_next_event_px(), elsewhere.t_px);
}

TEST_F(CheckedArrow, is_not_moved_by_what_fitted_a_shape_that_it_has_no_more) {
    follow_until_the_check_ends();
    const Eigen::Vector2d before_px = tracker_.snapshots().front().pose.t_px;
    ObjectUpdate other;
    other.shape = test::ring("arrow", 12, 24);
    other.estimator = EstimatorKind::kalman;
    ASSERT_TRUE(tracker_.update_object(other));
    EXPECT_LT((place_after_the_next_event_px() - before_px).norm(), 2);
}

}  // namespace
}  // namespace pursuit::tracker
