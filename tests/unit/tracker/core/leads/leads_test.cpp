// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "services/tracker/core/leads/backlash.hpp"
#include "services/tracker/core/leads/lead_prior.hpp"
#include "services/tracker/core/noise/clutter.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

TEST(Backlash, follows_a_way_across_the_piece_however_slow_and_not_one_along_it) {
    Backlash backlash;
    backlash.restart(1);
    const Eigen::Vector2d up(0, -1);
    EXPECT_EQ(backlash.gone(0, {10, 10}, {0, 0}, up, 0), 0);
    EXPECT_NEAR(backlash.gone(0, {90, 9.85}, {0, 0}, up, 0), 0.5, 1e-9);
    EXPECT_EQ(backlash.gone(0, {900, 5}, {0, 0}, up, 0), 1);
    EXPECT_EQ(backlash.gone(0, {-900, 5}, {0, 0}, up, 0), 1);
}

TEST(Backlash, turns_to_the_other_side_within_twice_its_half_width_of_the_way_back) {
    Backlash backlash;
    backlash.restart(2);
    const Eigen::Vector2d right(1, 0);
    backlash.gone(1, {0, 0}, {0, 0}, right, 0);
    EXPECT_EQ(backlash.gone(1, {3, 0}, {0, 0}, right, 0), 1);
    EXPECT_NEAR(backlash.gone(1, {2.7, 0}, {0, 0}, right, 0), 0, 1e-9);
    EXPECT_NEAR(backlash.gone(1, {2.4, 0}, {0, 0}, right, 0), -1, 1e-9);
    EXPECT_EQ(backlash.gone(0, {2.4, 0}, {0, 0}, right, 0), 0);  // Each piece has its own.
}

TEST(Backlash, has_turned_until_it_is_past_what_it_came_back_on) {
    Backlash backlash;
    backlash.restart(1);
    const Eigen::Vector2d right(1, 0);
    backlash.gone(0, {0, 0}, {0, 0}, right, 0);
    backlash.gone(0, {9, 0}, {0, 0}, right, 0);
    EXPECT_FALSE(backlash.has_turned(0));
    EXPECT_TRUE(backlash.is_settled(0));
    for (const double x : {8.9, 8.8}) backlash.gone(0, {x, 0}, {0, 0}, right, 0);
    EXPECT_FALSE(backlash.has_turned(0));  // Not yet: the pixels have not told.
    for (const double x : {8.6, 8.0}) backlash.gone(0, {x, 0}, {0, 0}, right, 0);
    EXPECT_TRUE(backlash.has_turned(0));
    EXPECT_FALSE(backlash.is_settled(0));
    backlash.gone(0, {7.5, 0}, {0, 0}, right, 0);
    EXPECT_TRUE(backlash.has_turned(0));
    EXPECT_TRUE(backlash.is_settled(0));
    backlash.gone(0, {6.5, 0}, {0, 0}, right, 0);
    EXPECT_FALSE(backlash.has_turned(0));
}

TEST(Backlash, is_told_the_same_of_a_piece_beside_the_pose_by_its_place_along_the_normal) {
    Backlash one;
    Backlash other;
    one.restart(1);
    other.restart(1);
    const Eigen::Vector2d n(0.6, -0.8);
    for (const double x : {50.0, 50.02, 50.1, 50.05, 50.3, 49.9}) {
        const Eigen::Vector2d t(x, 20);
        const Eigen::Vector2d arm(12 + x, -7);
        EXPECT_NEAR(one.gone(0, t, arm, n, n.dot(arm)), other.gone(0, t + arm, {0, 0}, n, 0), 1e-9);
    }
}

TEST(Backlash, of_a_piece_that_trembles_on_its_way_is_settled) {
    Backlash backlash;
    backlash.restart(1);
    for (int i = 0; i < 100; ++i) {
        backlash.gone(0, {0.1 * i + (i % 2 == 0 ? 0.1 : -0.1), 0}, {0, 0}, {1, 0}, 0);
    }
    EXPECT_TRUE(backlash.is_settled(0));
    EXPECT_FALSE(backlash.has_turned(0));
}

TEST(LeadPrior, goes_by_physics_where_pixels_see_again_soon_and_noise_and_jitter_are_small) {
    const auto weights = [](double blind_us, double own_share, double gain = 0.5) {
        LeadPrior prior;
        prior.set_blind_us(blind_us);
        prior.look(1000, LeadPrior::mean_px(), 1000, {own_share, gain}, true);
        return prior.weights();
    };
    const Eigen::Vector4d by_physics(0.5, 0, 0.5, 0);
    EXPECT_EQ(weights(100, 1), by_physics);
    EXPECT_NE(weights(5000, 1), by_physics);
    EXPECT_NE(weights(100, 0.5), by_physics);
    EXPECT_NE(weights(100, 1, 2.5), by_physics);
}

TEST(LeadPrior, holds_the_first_leads_where_blind_pixels_make_no_other_and_else_the_mean_of_all) {
    LeadPrior prior;
    prior.set_blind_us(5000);
    prior.look(1000, LeadPrior::mean_px(), 1000, {}, true);
    EXPECT_EQ(prior.weights(), Eigen::Vector4d(1.3, 0, -0.3, 0));
    // Two subsequent events for each first one, ON and OFF.
    for (int i = 0; i < 30'000; ++i) {
        prior.count(i % 3 == 0 ? 0 : 1, 1);
        prior.count(i % 3 == 0 ? 2 : 3, 1);
    }
    const Eigen::Vector4d all = prior.weights();
    EXPECT_NEAR(all(0), 1.0 / 6, 0.01);
    EXPECT_NEAR(all(1), 1.0 / 3, 0.01);
    EXPECT_NEAR(all.sum(), 1, 1e-9);
}

TEST(LeadPrior, expects_before_any_event_what_it_holds_later_as_far_as_that_is_known) {
    const LeadPrior prior;
    const double expected_px = prior.weights().dot(LeadPrior::mean_px());
    EXPECT_NEAR(expected_px, prior.held_px(), LeadPrior::held_sigma_px);
    const double apart_px = prior.apart_weights().dot(LeadPrior::mean_px());
    EXPECT_NEAR(apart_px, prior.apart_px(), LeadPrior::apart_sigma_px);
}

TEST(LeadPrior, holds_on_and_off_apart_by_the_means_over_their_events) {
    LeadPrior prior;
    for (int i = 0; i < 30'000; ++i) {
        prior.count(i % 4 == 0 ? 0 : 1, 1);
        prior.count(i % 2 == 0 ? 2 : 3, 1);
    }
    const Eigen::Vector4d leads_px(0.1, -0.5, 0.7, 0.2);
    const double off_px = 0.25 * 0.1 + 0.75 * -0.5;
    const double on_px = 0.5 * 0.7 + 0.5 * 0.2;
    EXPECT_NEAR(prior.apart_weights().dot(leads_px), on_px - off_px, 0.01);
}

Shape square() { return test::polygon("square", {{-20, -20}, {20, -20}, {20, 20}, {-20, 20}}); }

/// How far ahead of where its events come from a square is said to be, px, that goes right and
/// down.
double ahead_of_its_events_px(const Shape& shape) {
    const auto where = [](double t_us) {
        return pose_of(60 + 120e-6 * t_us, 60 + 90e-6 * t_us, 0, 1, 1);
    };
    const auto events =
        test::outline_events(square(), where, 0, 1'000'000, 240, 0, test::small_sensor, 3);
    Tracker tracker = Tracker::create({}).value();
    tracker.begin_stream(test::small_sensor, 1);
    Registration registration;
    registration.shape = shape;
    registration.estimator = EstimatorKind::kalman;
    registration.start.pose = where(0);
    tracker.register_object(registration).value();
    test::Poses poses;
    tracker.process(events, poses);
    double sum_px = 0;
    int count = 0;
    for (const auto& row : poses.rows) {
        if (row.record.t_us < 200'000) continue;
        const Pose truth = where(static_cast<double>(row.record.t_us));
        sum_px += (row.record.pose.t_px - truth.t_px).dot(Eigen::Vector2d(0.8, 0.6));
        ++count;
    }
    return sum_px / count;
}

TEST(Leads, are_none_of_a_contour_that_was_told_by_events_itself) {
    const Shape outline = square();
    Shape of_events = outline;
    std::erase_if(of_events.edges, [](const Edge& edge) { return edge.from % 4 == 0; });
    EXPECT_FALSE(Contour(outline).is_of_events());
    EXPECT_TRUE(Contour(of_events).is_of_events());
    const double ahead_px = ahead_of_its_events_px(of_events);
    EXPECT_NEAR(ahead_px, 0, 0.1);
    // What was drawn is expected elsewhere, by its leads.
    EXPECT_GT(std::abs(ahead_of_its_events_px(outline) - ahead_px), 0.05);
    // What was drawn has them.
    EXPECT_NE(ahead_of_its_events_px(outline), ahead_px);
}

/// Events a second on the contour and beside it, drawn at random, for some time.
void see(Clutter& clutter, double near_hz, double left_hz, double right_hz, double seconds) {
    static std::mt19937 random(7);
    const double all_hz = near_hz + left_hz + right_hz;
    std::exponential_distribution<double> wait_s(all_hz);
    std::uniform_real_distribution<double> which(0, all_hz);
    static double t_s = 0;
    for (const double end_s = t_s + seconds; t_s < end_s; t_s += wait_s(random)) {
        clutter.reach(static_cast<std::int64_t>(t_s * 1e6));
        const double drawn = which(random);
        if (drawn < near_hz) {
            clutter.pass_near();
            clutter.count_near(0, 0.5);
        } else {
            clutter.count_far(0, drawn < near_hz + left_hz ? -5 : 5);
        }
    }
}

TEST(Clutter, knows_noise_alone_and_when_there_is_more) {
    Contour contour(test::polygon("box", {{-22, -22}, {22, -22}, {22, 22}, {-22, 22}}));
    contour.fit(Eigen::Matrix2d::Identity(), 8);
    Clutter clutter;
    clutter.restart();
    clutter.sample(contour, Eigen::Matrix2d::Identity());
    // The box is 176 px round: 3 px beside it on each side, 4 px on it; 20 events a second and px².
    const double beside_hz = 20 * 176 * 3;
    const double on_hz = 20 * 176 * 8;
    see(clutter, on_hz, beside_hz, beside_hz, 0.3);
    EXPECT_TRUE(clutter.is_noise_alone());
    see(clutter, 2 * on_hz, beside_hz, beside_hz, 0.05);
    EXPECT_FALSE(clutter.is_noise_alone());
    see(clutter, on_hz, beside_hz, beside_hz, 0.3);
    EXPECT_TRUE(clutter.is_noise_alone());
    // What comes on one side alone is something else's edge.
    see(clutter, on_hz, 2 * beside_hz, 0, 0.6);
    EXPECT_FALSE(clutter.is_noise_alone());
}

TEST(Clutter, is_swamped_by_steady_noise_of_300_hz_a_pixel_and_not_by_100) {
    Contour contour(test::polygon("box", {{-22, -22}, {22, -22}, {22, 22}, {-22, 22}}));
    contour.fit(Eigen::Matrix2d::Identity(), 8);
    for (const double of_px_hz : {100.0, 300.0}) {
        Clutter clutter;
        clutter.restart();
        clutter.sample(contour, Eigen::Matrix2d::Identity());
        // 176 px of contour: 4 px near it on each side; 3 px beside it are longer outside.
        see(clutter, 2 * 4 * 176 * of_px_hz, 3 * 156 * of_px_hz, 3 * 196 * of_px_hz, 0.2);
        EXPECT_EQ(clutter.is_swamped(), of_px_hz > 200) << of_px_hz;
    }
}

}  // namespace
}  // namespace pursuit::tracker
