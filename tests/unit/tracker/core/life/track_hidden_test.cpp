// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "services/tracker/core/life/track.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

/// An arrow that goes right at 60 px/s, and from t 1 s on does so 45 px further down.
class ArrowThatJumps : public ::testing::Test {
 protected:
    static constexpr std::int64_t jump_us = 1'000'000;

    ArrowThatJumps() {
        pixels_.restart(test::small_sensor);
        track_.begin_stream(1, 0);
    }

    static Pose pose_at(double t_us) {
        return pose_of(50 + 60e-6 * t_us, t_us < jump_us ? 90 : 135, 0);
    }
    static RegisteredObject arrow() {
        RegisteredObject object;
        object.object_id = 1;
        object.shape = test::arrow();
        object.estimator = EstimatorKind::kalman;
        object.start.pose = pose_at(0);
        return object;
    }

    void follow(std::int64_t from_us, std::int64_t to_us) {
        for (const Event& event : test::outline_events(test::arrow(), pose_at, from_us, to_us, 160,
                                                       0, test::small_sensor, 1)) {
            if (event.t_us >= round_us_) {
                track_.reach_time(event.t_us, pixels_);
                track_.tally(event.t_us, true);
                track_.end_tally(event.t_us);
                round_us_ = event.t_us + 2'000;
            }
            if (track_.approach(event, pixels_.note(event)) != nullptr) track_.take(event, 1);
        }
    }
    /// How it goes on when all of it is covered at once.
    Velocity covered(std::int64_t t_us) {
        for (Outline::Part& part : track_.outline().parts()) part.is_hidden = true;
        track_.see(t_us);
        return track_.now(t_us).velocity;
    }

    Track track_{arrow(), TrackerParameters()};
    RecentPixels pixels_;
    std::int64_t round_us_ = 0;
};

void expect_no_way_down(const Velocity& velocity) {
    EXPECT_NEAR(velocity.vx_px_s, 60, 3);
    EXPECT_NEAR(velocity.vy_px_s, 0, 3);
}

TEST_F(ArrowThatJumps, goes_on_under_another_as_it_went_since_it_was_moved) {
    follow(0, jump_us);
    track_.move_to(jump_us, pose_at(jump_us), {60, 0, 0, 0, 0});
    follow(jump_us, 1'500'000);
    ASSERT_LT(test::rms_px(test::arrow(), track_.pose(), pose_at(1.5e6)), 1);
    expect_no_way_down(covered(1'500'000));
}

TEST_F(ArrowThatJumps, goes_on_under_another_as_it_went_since_it_was_acquired_again) {
    follow(0, jump_us);
    track_.offer(jump_us, pose_at(jump_us));
    ASSERT_FALSE(track_.is_followed());
    follow(jump_us, 1'500'000);
    ASSERT_TRUE(track_.is_followed());
    ASSERT_LT(test::rms_px(test::arrow(), track_.pose(), pose_at(1.5e6)), 1);
    expect_no_way_down(covered(1'500'000));
}

}  // namespace
}  // namespace pursuit::tracker
