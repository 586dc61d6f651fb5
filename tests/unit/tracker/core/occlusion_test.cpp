// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/occlusion.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::outline_events;
using test::Poses;
using test::rms_px;
using test::small_sensor;

/// A small arrow that goes right at 60 px/s, and a wide box that stands over its way from t 1 s on.
class HiddenArrow : public ::testing::Test {
 protected:
    static Shape box() {
        return test::polygon("box", {{-70, -50}, {70, -50}, {70, 50}, {-70, 50}});
    }
    static Pose arrow_at(double t_us) { return pose_of(40 + 60e-6 * t_us, 120, 0); }
    static Pose box_at(double t_us) { return pose_of(170 + 2 * std::sin(9e-6 * t_us), 120, 0); }

    /// What is seen: the box whole, of the arrow what lies outside the box. (With a quarter of the
    /// events an arrow of this size is followed by half of the draws only, with these by all
    /// of 24.)
    static std::vector<Event> seen(std::int64_t to_us) {
        auto events = outline_events(box(), box_at, 0, to_us, 160, 0, small_sensor, 1);
        for (const Event& event :
             outline_events(test::arrow(), arrow_at, 0, to_us, 160, 0, small_sensor, 2)) {
            const Eigen::Vector2d m =
                Eigen::Vector2d(event.x, event.y) - box_at(static_cast<double>(event.t_us)).t_px;
            if (std::abs(m.x()) > 70 || std::abs(m.y()) > 50) events.push_back(event);
        }
        std::stable_sort(events.begin(), events.end(),
                         [](const Event& l, const Event& r) { return l.t_us < r.t_us; });
        return events;
    }

    void add(const Shape& shape, const Pose& start, double depth_order) {
        Registration registration;
        registration.shape = shape;
        registration.estimator = EstimatorKind::kalman;
        registration.start.pose = start;
        registration.parameters = {{"depth_order", depth_order}};
        ASSERT_TRUE(tracker_.register_object(registration));
    }
    void begin(double depth_of_arrow, double depth_of_box) {
        tracker_.begin_stream(small_sensor, 1);
        add(test::arrow(), arrow_at(0), depth_of_arrow);
        add(box(), box_at(0), depth_of_box);
    }
    /// Of the arrow, at this time.
    PoseRecord at(std::int64_t t_us) const {
        for (const auto& row : poses_.rows) {
            if (row.record.object_id == 1 && row.record.t_us == t_us) return row.record;
        }
        ADD_FAILURE() << "no pose at " << t_us;
        return {};
    }

    Tracker tracker_ = std::move(*Tracker::create({}));
    Poses poses_;
};

TEST_F(HiddenArrow, is_occluded_while_it_is_covered_and_goes_on_where_it_would_be) {
    for (const bool is_given : {false, true}) {
        tracker_ = std::move(*Tracker::create({}));
        poses_ = {};
        begin(is_given ? 2 : 0, is_given ? 1 : 0);
        tracker_.process(seen(4'200'000), poses_);
        EXPECT_EQ(at(500'000).state, TrackState::tracking);
        for (const std::int64_t t_us : {1'900'000, 2'300'000, 2'700'000}) {
            EXPECT_EQ(at(t_us).state, TrackState::occluded) << is_given << " " << t_us;
            EXPECT_EQ(at(t_us).confidence, 0) << is_given << " " << t_us;
            EXPECT_LT(rms_px(test::arrow(), at(t_us).pose, arrow_at(static_cast<double>(t_us))), 6)
                << is_given << " " << t_us;
        }
        EXPECT_EQ(at(4'100'000).state, TrackState::tracking) << is_given;
        EXPECT_LT(rms_px(test::arrow(), at(4'100'000).pose, arrow_at(4.1e6)), 1) << is_given;
    }
}

TEST_F(HiddenArrow, is_kept_for_a_further_run_with_the_time_of_its_pose_covered_or_not) {
    begin(0, 0);
    const auto events = seen(4'200'000);
    bool was_covered = false;
    auto done = events.begin();
    for (std::int64_t t_us = 1'000'000; t_us <= 4'200'000; t_us += 1'000) {
        const auto until = std::find_if(done, events.end(),
                                        [&](const Event& event) { return event.t_us >= t_us; });
        tracker_.process({done, until}, poses_);
        done = until;
        const TrackSnapshot now = tracker_.snapshots().front();
        ASSERT_LT(rms_px(test::arrow(), now.pose, arrow_at(static_cast<double>(now.t_us))), 6)
            << t_us;
        was_covered |= now.state == TrackState::occluded && t_us == 2'300'000;
    }
    EXPECT_TRUE(was_covered);
    EXPECT_EQ(at(4'100'000).state, TrackState::tracking);
}

TEST_F(HiddenArrow, is_not_left_frozen_when_occlusion_is_no_more_told) {
    begin(2, 1);
    const auto events = seen(4'500'000);
    const auto middle = std::find_if(events.begin(), events.end(),
                                     [](const Event& event) { return event.t_us >= 2'300'000; });
    tracker_.process({events.begin(), middle}, poses_);
    ASSERT_EQ(at(2'280'000).state, TrackState::occluded);
    const std::vector<NamedValue> off{{"tells_occlusion", 0}};
    ASSERT_TRUE(tracker_.set_parameters("", off));
    tracker_.process({middle, events.end()}, poses_);
    // Nobody says any more that it is hidden: it is not there, and is found when it is.
    EXPECT_EQ(at(2'400'000).state, TrackState::occluded);
    EXPECT_EQ(at(3'150'000).state, TrackState::lost);
    // All of it is out from under the box, and its tip not yet out of the image.
    EXPECT_EQ(at(3'840'000).state, TrackState::tracking);
    EXPECT_LT(rms_px(test::arrow(), at(3'840'000).pose, arrow_at(3.84e6)), 1);
}

// The arrow stops, and noise tells that it stands; the box comes over its head and stops as well.
TEST_F(HiddenArrow, stays_behind_the_box_while_both_stand) {
    constexpr std::int64_t arrow_stops_us = 400'000;
    constexpr std::int64_t box_goes_us = 2'400'000;
    constexpr std::int64_t box_stops_us = 4'000'000;
    const auto coming = [](double t_us) {
        return pose_of(230 - 60e-6 * (t_us - box_goes_us), 120, 0);
    };
    std::vector<Track> tracks;
    const auto follow = [&](std::uint32_t object_id, const Shape& shape, const Pose& start) {
        RegisteredObject object;
        object.object_id = object_id;
        object.shape = shape;
        object.estimator = EstimatorKind::kalman;
        object.start.pose = start;
        tracks.emplace_back(object, TrackerParameters());
        tracks.back().begin_stream(1, 0);
    };
    follow(1, test::arrow(), arrow_at(0));
    follow(2, box(), coming(box_goes_us));
    RecentPixels pixels;
    pixels.restart(small_sensor);
    Occlusion occlusion;
    const auto reach = [&](std::int64_t t_us) {
        if (t_us < occlusion.next_us()) return;
        occlusion.look(t_us, tracks);
        for (Track& track : tracks) track.reach_time(t_us, pixels);
    };
    const auto give = [&](Track& track, const std::vector<Event>& events) {
        for (const Event& event : events) {
            reach(event.t_us);
            if (track.approach(event, pixels.note(event)) != nullptr) track.take(event, 1);
        }
    };
    give(tracks[0],
         outline_events(test::arrow(), arrow_at, 0, arrow_stops_us, 160, 0, small_sensor, 1));
    give(tracks[0], outline_events(test::arrow(), arrow_at, arrow_stops_us, box_goes_us, 0, 0.5,
                                   small_sensor, 2));
    give(tracks[1],
         outline_events(box(), coming, box_goes_us, box_stops_us, 160, 0, small_sensor, 3));
    ASSERT_TRUE(occlusion.has_over(0));
    for (std::int64_t t_us = box_stops_us; t_us < 8'000'000; t_us += 2'000) reach(t_us);
    EXPECT_TRUE(occlusion.has_over(0));
    EXPECT_FALSE(occlusion.has_over(1));
}

TEST_F(HiddenArrow, is_lost_when_it_does_not_come_out_again) {
    tracker_.begin_stream(small_sensor, 1);
    add(test::arrow(), arrow_at(0), 2);
    add(box(), box_at(0), 1);
    // It stops under the box, where nobody sees it.
    auto events = seen(2'400'000);
    const auto alone = outline_events(box(), box_at, 2'400'000, 7'500'000, 40, 0, small_sensor, 3);
    events.insert(events.end(), alone.begin(), alone.end());
    tracker_.process(events, poses_);
    EXPECT_EQ(poses_.rows.back().record.object_id, 2U);
    EXPECT_EQ(at(7'400'000).state, TrackState::lost);
}

}  // namespace
}  // namespace pursuit::tracker
