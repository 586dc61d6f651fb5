// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/doubt.hpp"

#include <gtest/gtest.h>

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

// A shape fixed off the centre of a turning disc.
Pose turning(double t_us, double omega_rad_s) {
    const double angle = omega_rad_s * t_us * 1e-6;
    return pose_of(150 + 35 * std::cos(angle), 115 + 35 * std::sin(angle), angle);
}

TEST(Coast, goes_on_as_a_rigid_body_on_a_turning_disc_does) {
    for (const double omega_rad_s : {0.0, 1e-5, 70.0, -131.0}) {
        Coast coast{1'000, turning(1'000, omega_rad_s), {}};
        const Eigen::Vector2d arm = coast.pose.t_px - Eigen::Vector2d(150, 115);
        coast.velocity = {-omega_rad_s * arm.y(), omega_rad_s * arm.x(), omega_rad_s, 0, 0};
        for (const std::int64_t t_us : {0, 1'000, 6'000, 91'000}) {
            const Coast gone = coast.at(t_us, 1);
            const Pose truth = turning(static_cast<double>(t_us), omega_rad_s);
            EXPECT_LT((gone.pose.t_px - truth.t_px).norm(), 1e-9) << omega_rad_s << ' ' << t_us;
            EXPECT_LT((gone.pose.a - truth.a).norm(), 1e-9) << omega_rad_s << ' ' << t_us;
            // And there it goes on from, all the way back.
            EXPECT_LT((gone.at(1'000, 1).pose.t_px - coast.pose.t_px).norm(), 1e-9);
        }
    }
}

TEST(Coast, goes_straight_on_where_it_does_not_turn_and_no_longer_than_asked) {
    const Coast coast{0, pose_of(10, 20, 0.3), {100, -50, 0, 0, 0}};
    EXPECT_LT((coast.at(500'000, 1).pose.t_px - Eigen::Vector2d(60, -5)).norm(), 1e-9);
    EXPECT_LT((coast.at(900'000, 0.1).pose.t_px - Eigen::Vector2d(20, 15)).norm(), 1e-9);
}

Doubt::Finding here(bool is_sure) { return {true, true, is_sure, 0.02, {0, 0}}; }
Doubt::Finding elsewhere(bool is_sure, double gain, double x_px = 9) {
    return {false, true, is_sure, gain, {x_px, 0}};
}

TEST(Doubt, is_settled_by_as_many_sure_findings_as_were_asked_for) {
    Doubt doubt;
    EXPECT_FALSE(doubt.is_open());
    doubt.begin(100, 2, 100);
    EXPECT_TRUE(doubt.is_open());
    EXPECT_FALSE(doubt.is_due(101));  // the events have to come first
    EXPECT_TRUE(doubt.is_due(100'000));
    EXPECT_FALSE(doubt.take(100'000, here(true)));
    EXPECT_TRUE(doubt.is_open());
    EXPECT_FALSE(doubt.is_due(100'001));
    EXPECT_FALSE(doubt.take(200'000, here(true)));
    EXPECT_FALSE(doubt.is_open());
}

TEST(Doubt, moves_the_object_for_one_sure_finding_that_fits_better) {
    Doubt doubt;
    doubt.begin(0, 3, 0);
    EXPECT_FALSE(doubt.take(10'000, elsewhere(true, 0.05)));
    EXPECT_TRUE(doubt.take(20'000, elsewhere(true, 0.3)));
}

TEST(Doubt, wants_more_of_a_finding_each_time_that_it_has_moved_the_object) {
    const auto moves = [](Doubt& doubt, double gain) {
        return doubt.take(10'000, {false, true, true, gain, {20, 0}});
    };
    Doubt doubt;
    doubt.begin(0, 3, 0);
    EXPECT_TRUE(moves(doubt, 0.15));
    doubt.begin_again(0, 3);
    EXPECT_FALSE(moves(doubt, 0.15));
    EXPECT_TRUE(moves(doubt, 0.25));
    doubt.begin_again(0, 3);
    EXPECT_FALSE(moves(doubt, 0.25));
    EXPECT_TRUE(moves(doubt, 0.35));
    // Another doubt has no such past.
    doubt.begin(0, 3, 0);
    EXPECT_TRUE(moves(doubt, 0.15));
}

TEST(Doubt, moves_the_object_for_unsure_findings_that_agree_and_not_for_those_that_do_not) {
    Doubt agreed;
    agreed.begin(0, 3, 0);
    EXPECT_FALSE(agreed.take(10'000, elsewhere(false, 0.15)));
    EXPECT_TRUE(agreed.take(20'000, elsewhere(false, 0.15)));

    Doubt scattered;
    scattered.begin(0, 3, 0);
    for (int i = 0; i < 20; ++i) {
        EXPECT_FALSE(scattered.take(10'000 * i, elsewhere(false, 0.15, i % 2 == 0 ? 9 : -9)));
    }
}

TEST(Doubt, waits_longer_and_longer_while_there_are_too_few_events_and_not_for_ever) {
    Doubt doubt;
    doubt.begin(0, 1, 0);
    std::int64_t t_us = 10'000;
    std::int64_t last_us = 0;
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(doubt.is_due(t_us));
        doubt.wait(t_us);
        std::int64_t waited_us = 0;
        while (!doubt.is_due(t_us + waited_us)) waited_us += 1'000;
        EXPECT_GE(waited_us, last_us);
        EXPECT_LE(waited_us, 32'000);
        last_us = waited_us;
        t_us += waited_us;
    }
    EXPECT_TRUE(doubt.is_open());
}

TEST(Doubt, ends_by_itself_when_no_search_is_sure) {
    Doubt doubt;
    doubt.begin(0, 3, 0);
    int searches = 0;
    while (doubt.is_open() && searches < 1000) {
        EXPECT_FALSE(doubt.take(10'000 * searches, elsewhere(false, 0)));
        ++searches;
    }
    EXPECT_LE(searches, 40);
}

TEST(Doubt, finds_a_fast_object_that_starts_20_px_and_a_fifth_of_a_radian_off) {
    const auto truth = [](double t_us) { return turning(t_us, 70); };
    for (const double direction : {0.0, 1.6, 3.1, 4.7}) {
        Pose start = truth(0);
        start.t_px += 20 * Eigen::Vector2d(std::cos(direction), std::sin(direction));
        start.a = rotation(0.2) * start.a;
        Tracker tracker = that_follows_an_arrow(start);
        Poses poses;
        tracker.process(outline_events(arrow(), truth, 0, 200'000, 300, 5, small_sensor, 3), poses);
        for (const auto& row : poses.rows) {
            const auto t_us = static_cast<double>(row.record.t_us);
            const double off_px = rms_px(arrow(), row.record.pose, truth(t_us));
            ASSERT_FALSE(row.record.confidence > 0.5F && off_px > 10) << row.record.t_us;
            if (row.record.t_us > 50'000) {
                ASSERT_LT(off_px, 1) << row.record.t_us;
            }
        }
    }
}

TEST(Doubt, checks_nothing_where_it_is_switched_off) {
    const auto truth = [](double t_us) { return turning(t_us, 70); };
    Pose start = truth(0);
    start.t_px.x() += 20;
    Tracker tracker = that_follows_an_arrow(start);
    const std::vector<NamedValue> off{{"checks_pose", 0}, {"let_go_sharpness", 0}};
    ASSERT_TRUE(tracker.set_parameters("", off));
    Poses poses;
    tracker.process(outline_events(arrow(), truth, 0, 100'000, 300, 5, small_sensor, 3), poses);
    EXPECT_GT(rms_px(arrow(), poses.rows.back().record.pose, truth(99e3)), 5);
}

TEST(Doubt, takes_up_a_turning_object_after_a_silence_and_never_lies_in_it) {
    const auto truth = [](double t_us) { return turning(t_us, 131); };
    for (const std::int64_t gap_us : {5'000, 30'000, 90'000}) {
        const std::int64_t end_us = 200'000 + gap_us;
        auto events = outline_events(arrow(), truth, 0, 200'000, 300, 1, small_sensor, 7);
        const auto after =
            outline_events(arrow(), truth, end_us, end_us + 60'000, 300, 1, small_sensor, 8);
        events.insert(events.end(), after.begin(), after.end());
        Tracker tracker = that_follows_an_arrow(truth(0));
        Poses poses;
        tracker.process(events, poses);
        for (const auto& row : poses.rows) {
            const auto t_us = static_cast<double>(row.record.t_us);
            const double off_px = rms_px(arrow(), row.record.pose, truth(t_us));
            ASSERT_FALSE(row.record.confidence > 0.5F && off_px > 10) << row.record.t_us;
            if (row.record.t_us > end_us + 20'000) {
                ASSERT_LT(off_px, 1) << row.record.t_us;
            }
        }
    }
}

}  // namespace
}  // namespace pursuit::tracker
