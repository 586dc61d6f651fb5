// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "services/tracker/core/geometry/silhouette.hpp"
#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow;
using test::outline_events;
using test::Poses;
using test::rms_px;
using test::small_sensor;
using test::that_follows_an_arrow;

Pose swinging(double t_us) {
    const double t_s = t_us * 1e-6;
    return pose_of(150 + 60 * std::sin(3 * t_s), 110 + 30 * std::sin(4 * t_s),
                   0.6 * std::sin(2.5 * t_s));
}

const PoseRecord& last(const Poses& poses) { return poses.rows.back().record; }

TEST(Life, of_a_still_object_stays_tracking_with_falling_confidence) {
    const auto truth = [](double t_us) { return swinging(std::min(t_us, 500'000.0)); };
    auto events = outline_events(arrow(), truth, 0, 500'000, 60, 5, small_sensor, 1);
    const auto noise = outline_events(arrow(), truth, 500'000, 3'000'000, 0, 5, small_sensor, 2);
    events.insert(events.end(), noise.begin(), noise.end());
    Tracker tracker = that_follows_an_arrow(truth(0));
    Poses poses;
    tracker.process(events, poses);
    tracker.advance(6'000'000, poses);
    for (const auto& row : poses.rows) {
        ASSERT_EQ(row.record.state, TrackState::tracking) << row.record.t_us;
    }
    // Noise beside the contour pulls at it while nothing else comes; it must not carry it off.
    EXPECT_LT(rms_px(arrow(), last(poses).pose, truth(1e6)), 5);
    EXPECT_LT(last(poses).confidence, 0.5F);
}

TEST(Life, of_an_object_that_stands_where_it_starts_is_tracking_in_little_noise_until_it_goes) {
    // Standing for 1.5 s, then at 60 px/s, with as many events as a real pixel makes.
    const auto truth = [](double t_us) {
        return pose_of(120 + 60e-6 * std::max(t_us - 1'500'000, 0.0), 110, 0.4);
    };
    for (const double noise_hz : {0.02, 0.1, 0.4, 1.0, 2.0}) {
        auto events = outline_events(arrow(), truth, 0, 1'500'000, 0, test::noise_per_ms(noise_hz),
                                     small_sensor, 1);
        const auto going = outline_events(arrow(), truth, 1'500'000, 2'000'000, 200,
                                          test::noise_per_ms(noise_hz), small_sensor, 2);
        events.insert(events.end(), going.begin(), going.end());
        Tracker tracker = that_follows_an_arrow(truth(0));
        Poses poses;
        tracker.process(events, poses);
        for (const auto& row : poses.rows) {
            ASSERT_EQ(row.record.state, TrackState::tracking) << noise_hz << " " << row.record.t_us;
            if (row.record.t_us > 1'000'000 && row.record.t_us < 1'500'000) {
                EXPECT_LE(row.record.confidence, 0.5F) << noise_hz;
                EXPECT_LT(rms_px(arrow(), row.record.pose, truth(0)), 2) << noise_hz;
            }
        }
        EXPECT_LT(rms_px(arrow(), last(poses).pose, truth(2e6)), 0.5) << noise_hz;
    }
}

TEST(Life, finds_an_object_that_starts_pixels_away) {
    for (const double off_px : {3.0, 8.0, 14.0, 20.0}) {
        for (const double direction : {0.0, 1.6, 3.1, 4.7}) {
            Pose start = swinging(0);
            start.t_px += off_px * Eigen::Vector2d(std::cos(direction), std::sin(direction));
            Tracker tracker = that_follows_an_arrow(start);
            Poses poses;
            tracker.process(outline_events(arrow(), swinging, 0, 1'000'000, 60, 5, small_sensor, 3),
                            poses);
            EXPECT_EQ(last(poses).state, TrackState::tracking) << off_px << " " << direction;
            EXPECT_LT(rms_px(arrow(), last(poses).pose, swinging(1e6)), 1)
                << off_px << " " << direction;
        }
    }
}

TEST(Life, never_says_confidently_that_another_shape_is_the_object) {
    const Shape box = test::polygon("box", {{-22, -22}, {22, -22}, {22, 22}, {-22, 22}});
    Tracker tracker = that_follows_an_arrow(swinging(0));
    Poses poses;
    tracker.process(outline_events(box, swinging, 0, 2'000'000, 60, 5, small_sensor, 4), poses);
    int confident = 0;
    for (const auto& row : poses.rows) {
        confident += row.record.state == TrackState::tracking && row.record.confidence > 0.5F;
    }
    EXPECT_LT(confident, 100);
    EXPECT_EQ(last(poses).state, TrackState::lost);
}

// By its lines alone: what the arrow covers is told of below. A box's sides lie on the arrow's now
// and then, so that it takes longer to tell.
TEST(Life, lets_go_of_an_object_that_is_replaced_mostly_within_100_ms_and_surely_within_150) {
    const Shape box = test::polygon("box", {{-22, -22}, {22, -22}, {22, 22}, {-22, 22}});
    int soon = 0;
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        auto events = outline_events(arrow(), swinging, 0, 800'000, 60, 5, small_sensor, seed);
        const auto other =
            outline_events(box, swinging, 800'000, 2'500'000, 60, 5, small_sensor, 100 + seed);
        events.insert(events.end(), other.begin(), other.end());
        Tracker tracker = that_follows_an_arrow(swinging(0));
        Poses poses;
        tracker.process(events, poses);
        // What it finds in the other's lines later it tries, and never believes.
        std::int64_t let_go_us = -1;
        int tried_ms = 0;
        for (const auto& row : poses.rows) {
            const PoseRecord& record = row.record;
            if (record.t_us < 200'000) continue;
            if (record.t_us < 800'000) {
                ASSERT_EQ(record.state, TrackState::tracking) << record.t_us;
            } else if (let_go_us < 0 && record.state != TrackState::tracking) {
                let_go_us = record.t_us;
                ASSERT_EQ(record.state, TrackState::lost);
                ASSERT_EQ(record.loss_cause, LossCause::does_not_fit);
            } else if (record.t_us > 900'000) {
                ASSERT_FALSE(record.state == TrackState::tracking && record.confidence > 0.5F)
                    << record.t_us << ' ' << record.confidence;
                if (record.state == TrackState::tracking) ++tried_ms;
            }
        }
        EXPECT_GT(let_go_us, 0);
        EXPECT_LE(let_go_us, 950'000) << seed;
        if (let_go_us <= 900'000) ++soon;
        EXPECT_LT(tried_ms, 160) << seed;  // of 1600
    }
    EXPECT_GE(soon, 9);
}

/// Every place that the arrow covers fires, within a ms from t_us.
std::vector<Event> arrow_goes(const Pose& at, std::int64_t t_us) {
    const Silhouette silhouette{Contour(arrow())};
    std::vector<Event> events;
    for (std::uint16_t y = 0; y < small_sensor.height; ++y) {
        for (std::uint16_t x = 0; x < small_sensor.width; ++x) {
            const Eigen::Vector2d q = Eigen::Vector2d(x, y) - at.t_px;
            if (silhouette.depth_px(at.a.transpose() * q) < 0) continue;
            events.push_back({t_us + (x * 7919 + y * 104729) % 1000, x, y, 1});
        }
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const Event& a, const Event& b) { return a.t_us < b.t_us; });
    return events;
}

TEST(Life, says_within_100_ms_that_an_object_is_gone_though_no_event_comes_any_more) {
    for (const std::int64_t still_us : {0, 300'000}) {
        const std::int64_t gone_us = 500'000 + still_us;
        const auto truth = [](double t_us) { return swinging(std::min(t_us, 500'000.0)); };
        auto events = outline_events(arrow(), truth, 0, 500'000, 60, 5, small_sensor, 1);
        const auto last_of_it = arrow_goes(truth(5e5), gone_us);
        events.insert(events.end(), last_of_it.begin(), last_of_it.end());
        Tracker tracker = that_follows_an_arrow(truth(0));
        Poses poses;
        tracker.process(events, poses);
        tracker.advance(3'000'000, poses);
        for (const auto& row : poses.rows) {
            const PoseRecord& record = row.record;
            if (record.t_us < gone_us) {
                EXPECT_EQ(record.state, TrackState::tracking) << record.t_us;
            } else if (record.t_us > gone_us + 2'000) {
                EXPECT_EQ(record.confidence, 0) << record.t_us;
            }
            if (record.t_us > gone_us + 100'000) {
                ASSERT_EQ(record.state, TrackState::lost) << record.t_us;
                ASSERT_EQ(record.loss_cause, LossCause::gone) << record.t_us;
            }
        }
    }
}

TEST(Life, finds_an_object_that_only_seemed_to_be_gone) {
    auto events = outline_events(arrow(), swinging, 0, 500'000, 60, 5, small_sensor, 1);
    const auto flash = arrow_goes(swinging(5e5), 500'000);
    events.insert(events.end(), flash.begin(), flash.end());
    // It stands where it was for a while, and goes on.
    const auto truth = [](double t_us) { return swinging(t_us - 200'000); };
    const auto after = outline_events(arrow(), truth, 700'000, 1'700'000, 60, 5, small_sensor, 2);
    events.insert(events.end(), after.begin(), after.end());
    Tracker tracker = that_follows_an_arrow(swinging(0));
    Poses poses;
    tracker.process(events, poses);
    EXPECT_EQ(last(poses).state, TrackState::tracking);
    EXPECT_LT(rms_px(arrow(), last(poses).pose, truth(1.7e6)), 1);
}

TEST(Life, goes_on_after_a_gap_in_the_stream) {
    for (const std::int64_t gap_us : {5'000, 40'000, 90'000}) {
        auto events = outline_events(arrow(), swinging, 0, 700'000, 60, 5, small_sensor, 7);
        const auto after =
            outline_events(arrow(), swinging, 700'000 + gap_us, 1'500'000, 60, 5, small_sensor, 8);
        events.insert(events.end(), after.begin(), after.end());
        Tracker tracker = that_follows_an_arrow(swinging(0));
        Poses poses;
        tracker.process(events, poses);
        EXPECT_EQ(last(poses).state, TrackState::tracking) << gap_us;
        EXPECT_LT(rms_px(arrow(), last(poses).pose, swinging(1.5e6)), 1) << gap_us;
    }
}

TEST(Life, finds_its_object_again_in_a_new_stream_around_the_last_pose) {
    Tracker tracker = that_follows_an_arrow(swinging(0));
    Poses poses;
    tracker.process(outline_events(arrow(), swinging, 0, 600'000, 60, 5, small_sensor, 9), poses);
    ASSERT_EQ(last(poses).state, TrackState::tracking);
    ASSERT_TRUE(tracker.snapshots()[0].was_tracked);
    EXPECT_LT(rms_px(arrow(), tracker.snapshots()[0].pose, swinging(6e5)), 2);
    tracker.begin_stream(small_sensor, 2);
    Poses again;
    const auto later = [](double t_us) { return swinging(t_us + 620'000); };
    tracker.process(outline_events(arrow(), later, 0, 500'000, 60, 5, small_sensor, 10), again);
    ASSERT_FALSE(again.rows.empty());
    EXPECT_EQ(again.rows.front().record.state, TrackState::occluded);
    EXPECT_EQ(last(again).state, TrackState::tracking);
    EXPECT_LT(rms_px(arrow(), last(again).pose, later(5e5)), 1);
}

TEST(Life, of_an_object_that_is_searched_begins_anew_with_a_stream_wherever_the_last_one_ended) {
    // There it is somewhere else.
    const auto then = [](double t_us) { return swinging(t_us - 10e6); };
    const auto now = [](double t_us) { return swinging(t_us + 1.3e6); };
    const auto before =
        outline_events(arrow(), then, 10'000'000, 10'160'000, 60, 5, small_sensor, 1);
    const auto after = outline_events(arrow(), now, 0, 400'000, 60, 5, small_sensor, 2);
    for (std::int64_t end_us = 10'020'000; end_us <= 10'160'000; end_us += 10'000) {
        Tracker tracker = std::move(*Tracker::create({}));
        Registration registration;
        registration.shape = arrow();
        registration.start.search = true;
        tracker.begin_stream(small_sensor, 1);
        ASSERT_TRUE(tracker.register_object(registration));
        const auto end = std::find_if(before.begin(), before.end(),
                                      [&](const Event& event) { return event.t_us >= end_us; });
        Poses poses;
        tracker.process(std::vector<Event>(before.begin(), end), poses);
        tracker.begin_stream(small_sensor, 2);
        poses = {};
        tracker.process(after, poses);
        EXPECT_EQ(last(poses).state, TrackState::tracking) << end_us;
        EXPECT_LT(rms_px(arrow(), last(poses).pose, now(4e5)), 2) << end_us;
    }
}

/// One that follows the swinging arrow from its start on.
void expect_poses_of_a_fresh_tracker(const Poses& again, const std::vector<Event>& stream) {
    Tracker fresh = that_follows_an_arrow(swinging(0));
    Poses at_first;
    fresh.process(stream, at_first);
    ASSERT_EQ(again.rows.size(), at_first.rows.size());
    for (std::size_t i = 0; i < again.rows.size(); ++i) {
        const PoseRecord& l = again.rows[i].record;
        const PoseRecord& r = at_first.rows[i].record;
        ASSERT_EQ(l.pose.t_px, r.pose.t_px) << i;
        ASSERT_EQ(l.pose.a, r.pose.a) << i;
        ASSERT_EQ(l.confidence, r.confidence) << i;
    }
}

TEST(Life, of_an_object_that_no_event_has_moved_begins_with_a_new_stream_as_with_its_first) {
    const auto stream = outline_events(arrow(), swinging, 0, 400'000, 60, 1500, small_sensor, 1);
    Tracker tracker = that_follows_an_arrow(swinging(0));
    // A minute late, and only beside the object.
    const auto x = static_cast<std::uint16_t>(std::lround(swinging(0).t_px.x()));
    const auto y = static_cast<std::uint16_t>(std::lround(swinging(0).t_px.y()) + 26);
    std::vector<Event> beside;
    for (std::int64_t i = 0; i < 1000; ++i) beside.push_back({60'000'000 + 100 * i, x, y, 1});
    Poses before;
    tracker.process(beside, before);
    ASSERT_EQ(last(before).events_used, 0U);
    tracker.begin_stream(small_sensor, 1);
    Poses again;
    tracker.process(stream, again);
    expect_poses_of_a_fresh_tracker(again, stream);
}

TEST(Life, after_a_pose_is_set_is_that_of_an_object_registered_there) {
    const auto stream = outline_events(arrow(), swinging, 0, 400'000, 60, 1500, small_sensor, 1);
    Tracker tracker = that_follows_an_arrow(swinging(0));
    Poses before;
    tracker.process(stream, before);
    ASSERT_GT(last(before).events_used, 1000U);
    ASSERT_TRUE(tracker.set_pose("arrow", {false, swinging(0), {}}));
    tracker.begin_stream(small_sensor, 2);
    Poses again;
    tracker.process(stream, again);
    expect_poses_of_a_fresh_tracker(again, stream);
}

TEST(Life, after_a_pose_is_set_is_of_that_time_and_of_no_event_until_one_is_used) {
    Tracker tracker = that_follows_an_arrow(swinging(0));
    Poses poses;
    tracker.process(outline_events(arrow(), swinging, 0, 200'000, 60, 5, small_sensor, 3), poses);
    EXPECT_GT(tracker.snapshots().at(0).t_us, 190'000);
    EXPECT_GT(last(poses).last_event_t_us, 190'000);
    const std::int64_t set_us = tracker.effective_time_us();
    ASSERT_TRUE(tracker.set_pose("arrow", {false, pose_of(50, 50, 0), {}}));
    const Event far_off{210'000, 300, 230, 1};
    tracker.process({&far_off, 1}, poses);
    tracker.advance(212'000, poses);
    EXPECT_EQ(tracker.snapshots().at(0).t_us, set_us);
    EXPECT_EQ(last(poses).last_event_t_us, 0);
    const auto there = [](double t_us) { return pose_of(50 + 2e-4 * (t_us - 220e3), 50, 0); };
    tracker.process(outline_events(arrow(), there, 220'000, 240'000, 60, 0, small_sensor, 4),
                    poses);
    EXPECT_GT(tracker.snapshots().at(0).t_us, 230'000);
    EXPECT_GT(last(poses).last_event_t_us, 230'000);
    tracker.begin_stream(small_sensor, 2);
    EXPECT_EQ(tracker.snapshots().at(0).t_us, 0);
}

TEST(Life, of_an_affine_shape_that_began_on_the_wrong_edges_goes_on_at_its_place) {
    // Drawn out, an H fits half of another one.
    const std::vector<Eigen::Vector2d> corners_px{{-20, -28}, {-8, -28}, {-8, -6}, {8, -6},
                                                  {8, -28},   {20, -28}, {20, 28}, {8, 28},
                                                  {8, 6},     {-8, 6},   {-8, 28}, {-20, 28}};
    const Shape letter = test::polygon("H", corners_px);
    const auto truth = [](double t_us) {
        return pose_of(150 + 30 * std::sin(4e-6 * t_us), 115 + 20 * std::sin(6e-6 * t_us),
                       1.5e-6 * t_us);
    };
    const auto events = outline_events(letter, truth, 0, 300'000, 300, 2, small_sensor, 5);
    for (const double off_px : {8.0, 11.0, 14.0, 20.0}) {
        for (int way = 0; way < 24; ++way) {
            Tracker tracker = Tracker::create({}).value();
            tracker.begin_stream(small_sensor, 1);
            Registration registration;
            registration.shape = letter;
            registration.transform = TransformKind::full_affine;
            registration.estimator = EstimatorKind::kalman;
            registration.start.pose = truth(0);
            registration.start.pose.a = rotation(way % 2 == 0 ? 0.12 : -0.12);
            registration.start.pose.t_px +=
                off_px * Eigen::Vector2d(std::cos(way * 0.524), std::sin(way * 0.524));
            ASSERT_TRUE(tracker.register_object(registration));
            Poses poses;
            tracker.process(events, poses);
            EXPECT_LT(rms_px(letter, last(poses).pose, truth(3e5)), 1) << off_px << ' ' << way;
        }
    }
}

}  // namespace
}  // namespace pursuit::tracker
