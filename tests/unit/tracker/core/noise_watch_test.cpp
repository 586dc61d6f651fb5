// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "services/tracker/core/contour_place.hpp"
#include "services/tracker/core/lookout.hpp"
#include "services/tracker/core/noise_watch.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::outline_events;
using test::rms_px;
using test::small_sensor;

// A pixel of the small sensor.
double noise_per_ms(double hz) { return hz * 304 * 240 * 1e-3; }

// An arrow at 500 px/s; fewer where it is slower. Two events for each px² that its contour covers.
constexpr double moving_per_ms = 170;

class LookingOut : public testing::Test {
 protected:
    LookingOut() {
        contour_.fit(Eigen::Matrix2d::Identity(), 8);
        lookout_.restart();
    }

    /// Looks five times and more about `own` at these events; the last look.
    Lookout::Sight look_at(const std::vector<Event>& events, const Pose& own) {
        Coast coast{0, own, {}};
        lookout_.look(coast, contour_.gyration_px(), contour_.radius_px(), true);
        Lookout::Sight sight;
        for (const Event& event : events) {
            while (event.t_us >= coast.t_us + Lookout::every_us) {
                coast.t_us += Lookout::every_us;
                sight = lookout_.look(coast, contour_.gyration_px(), contour_.radius_px(), true);
                most_z_ = std::max(most_z_, sight.own_z);
                times_elsewhere_ += sight.instead.has_value();
            }
            lookout_.see(event.x, event.y, event.polarity);
        }
        return sight;
    }

    const Shape shape_ = test::arrow();
    Contour contour_{shape_};
    Lookout lookout_{contour_};
    double most_z_ = -1e9;
    int times_elsewhere_ = 0;
};

TEST_F(LookingOut, sees_an_object_that_goes_among_noise_where_it_is_and_how_it_goes) {
    const auto truth = [](double t_us) {
        return pose_of(150 + 100e-6 * t_us, 120 - 60e-6 * t_us, 0.3 + 1e-6 * t_us);
    };
    const auto events =
        outline_events(shape_, truth, 0, 24'500, moving_per_ms, noise_per_ms(100), small_sensor, 3);
    // Its place is told 3 px off, and turned.
    Pose own = truth(24'000);
    own.t_px += Eigen::Vector2d(2, -2.2);
    own.a = rotation(-0.15) * own.a;
    const Lookout::Sight sight = look_at(events, own);
    EXPECT_LT(sight.own_z, 6);
    ASSERT_TRUE(sight.instead);
    EXPECT_GT(sight.instead_z, 8);
    EXPECT_LT(rms_px(shape_, sight.instead->pose, truth(24'000)), 1);
    EXPECT_NEAR(sight.instead->velocity.vx_px_s, 100, 50);
    EXPECT_NEAR(sight.instead->velocity.vy_px_s, -60, 50);
}

/// What a look at this shape finds, going, of its turns the one nearest to the angle.
double nearest_rad(const Shape& shape, double found_rad, double near_rad) {
    const auto truth = [](double t_us) { return pose_of(150 + 300e-6 * t_us, 120, 0.3); };
    Lookout lookout{Contour{shape}};
    Coast own{0, truth(0), {300, 0, 0, 0, 0}};
    lookout.look(own, 20, 30, true);
    for (const Event& event : outline_events(shape, truth, 0, 24'500, moving_per_ms,
                                             noise_per_ms(30), small_sensor, 3)) {
        while (event.t_us >= own.t_us + Lookout::every_us) {
            own = own.at(own.t_us + Lookout::every_us, 1);
            lookout.look(own, 20, 30, true);
        }
        lookout.see(event.x, event.y, event.polarity);
    }
    own.pose.a = rotation(found_rad);
    return theta_rad(lookout.nearest_turn(own, near_rad).pose.a);
}

TEST(NearestTurn, of_a_shape_that_maps_onto_itself_is_that_nearest_to_where_it_was) {
    std::vector<Eigen::Vector2d> corners_px;
    for (int i = 0; i < 10; ++i) {
        const double at_rad = i * std::numbers::pi / 5;
        const double r_px = i % 2 == 0 ? 30 : 13;
        corners_px.emplace_back(r_px * std::cos(at_rad), r_px * std::sin(at_rad));
    }
    const Shape star = test::polygon("star", corners_px);
    constexpr double of_a_turn_rad = 2 * std::numbers::pi / 5;
    EXPECT_NEAR(nearest_rad(star, 0.3 + of_a_turn_rad, 0.2), 0.3, 0.06);
    EXPECT_NEAR(nearest_rad(star, 0.3 - 2 * of_a_turn_rad, 0.5), 0.3, 0.06);
    EXPECT_NEAR(nearest_rad(star, 0.3, 0.2), 0.3, 1e-9);
}

TEST(NearestTurn, of_any_other_shape_is_the_one_that_was_found) {
    EXPECT_NEAR(nearest_rad(test::arrow(), 0.3, 1.5), 0.3, 1e-9);
}

TEST_F(LookingOut, sees_that_an_object_is_where_it_is_thought_to_be) {
    const auto truth = [](double t_us) { return pose_of(150 + 60e-6 * t_us, 120, 0.3); };
    const auto events =
        outline_events(shape_, truth, 0, 24'500, moving_per_ms, noise_per_ms(30), small_sensor, 4);
    const Lookout::Sight sight = look_at(events, truth(24'000));
    EXPECT_GT(sight.own_z, 8);
    EXPECT_FALSE(sight.instead);
}

TEST_F(LookingOut, sees_nothing_where_there_is_noise_alone) {
    for (const double hz : {20.0, 100.0, 300.0}) {
        most_z_ = -1e9;
        look_at(outline_events(
                    shape_, [](double) { return pose_of(150, 120, 0.3); }, 0, 120'500, 0,
                    noise_per_ms(hz), small_sensor, 5),
                pose_of(150, 120, 0.3));
        EXPECT_LT(most_z_, 4) << hz;
        lookout_.restart();
    }
    EXPECT_LE(times_elsewhere_, 1);
}

TEST_F(LookingOut, sees_that_there_is_noise_alone_beside_an_object_or_that_there_is_not) {
    const auto truth = [](double t_us) { return pose_of(150 + 100e-6 * t_us, 120, 0.3); };
    auto events =
        outline_events(shape_, truth, 0, 24'500, moving_per_ms, noise_per_ms(8), small_sensor, 4);
    EXPECT_TRUE(look_at(events, truth(24'000)).is_even);
    // Also where the object is rather elsewhere.
    Pose beside = truth(24'000);
    beside.t_px += Eigen::Vector2d(3, -4);
    lookout_.restart();
    const Lookout::Sight sight = look_at(events, beside);
    EXPECT_TRUE(sight.is_even);
    EXPECT_TRUE(sight.instead);

    // Windows that pass as a camera shakes; one of them is as long as the arrow.
    const Shape window = test::polygon("window", {{-30, -6}, {30, -6}, {30, 6}, {-30, 6}});
    const auto passing = [](double t_us) { return pose_of(148, 141 - 60e-6 * t_us, 0.25); };
    const auto of_window =
        outline_events(window, passing, 0, 24'500, moving_per_ms, 0, small_sensor, 5);
    events.insert(events.end(), of_window.begin(), of_window.end());
    std::stable_sort(events.begin(), events.end(),
                     [](const Event& l, const Event& r) { return l.t_us < r.t_us; });
    for (const Pose& own : {truth(24'000), beside}) {
        lookout_.restart();
        const Lookout::Sight among_others = look_at(events, own);
        EXPECT_FALSE(among_others.is_even);
        EXPECT_FALSE(among_others.instead);
    }
}

TEST(Lookout, takes_no_part_of_a_long_contour_for_something_else) {
    // A comb: 22 teeth, 1300 px of contour.
    std::vector<Eigen::Vector2d> corners_px{{-55, 20}};
    for (int i = 0; i < 22; ++i) {
        const double x_px = -55 + 5 * i;
        corners_px.insert(corners_px.end(),
                          {{x_px, -20 + 30 * (i % 2)}, {x_px + 5, -20 + 30 * (i % 2)}});
    }
    corners_px.emplace_back(55, 20);
    const Shape comb = test::polygon("comb", corners_px);
    const auto truth = [](double t_us) { return pose_of(150 + 100e-6 * t_us, 120, 0.3); };
    Contour contour{comb};
    Lookout lookout{contour};
    Coast own{0, truth(0), {100, 0, 0, 0, 0}};
    lookout.look(own, contour.gyration_px(), contour.radius_px(), true);
    Lookout::Sight sight;
    for (const Event& event : outline_events(comb, truth, 0, 44'500, 6 * moving_per_ms,
                                             noise_per_ms(8), small_sensor, 3)) {
        while (event.t_us >= own.t_us + Lookout::every_us) {
            own = own.at(own.t_us + Lookout::every_us, 1);
            sight = lookout.look(own, contour.gyration_px(), contour.radius_px(), true);
        }
        lookout.see(event.x, event.y, event.polarity);
    }
    EXPECT_GT(sight.own_z, 8);
    EXPECT_TRUE(sight.is_even);
}

TEST_F(LookingOut, sees_nothing_of_what_is_another_objects) {
    const auto truth = [](double t_us) { return pose_of(150 + 60e-6 * t_us, 120, 0.3); };
    const auto events = outline_events(shape_, truth, 0, 24'500, moving_per_ms, 0, small_sensor, 4);
    Coast own{0, truth(24'000), {}};
    lookout_.look(own, contour_.gyration_px(), contour_.radius_px(), true);
    for (const Event& event : events) {
        lookout_.see(event.x, event.y, event.polarity);
        lookout_.disown(event.x, event.y, event.polarity);
    }
    const auto& seen = lookout_.fresh().events;
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](const auto& of_pixel) {
        return of_pixel[0] == 0 && of_pixel[1] == 0;
    }));
    // What was never seen is not missed.
    lookout_.disown(150, 120, 1);
    lookout_.disown(0, 0, 0);
    lookout_.see(150, 120, 1);
    EXPECT_EQ(std::count_if(seen.begin(), seen.end(),
                            [](const auto& of_pixel) { return of_pixel[1] == 1; }),
              1);
}

TEST_F(LookingOut, takes_the_border_of_the_image_for_nothing) {
    // What lies beyond it makes no events.
    look_at(outline_events(
                shape_, [](double) { return pose_of(20, 15, 0.3); }, 0, 120'500, 0,
                noise_per_ms(100), small_sensor, 8),
            pose_of(20, 15, 0.3));
    EXPECT_LT(most_z_, 4);
    EXPECT_EQ(times_elsewhere_, 0);
}

TEST_F(LookingOut, takes_no_edge_of_something_else_for_the_object) {
    // As long as the arrow's longest, it goes along it and then on.
    Shape edge{"edge", {{-19, 0}, {19, 0}}, {{0, 1}}};
    const Pose own = pose_of(150, 120, 0);
    const auto passing = [](double t_us) { return pose_of(140, 100 + 300e-6 * t_us, 0); };
    auto events = outline_events(edge, passing, 0, 100'000, 60, noise_per_ms(30), small_sensor, 6);
    look_at(events, own);
    EXPECT_EQ(times_elsewhere_, 0);
}

/// What the estimator asks of a watch for an arrow that makes 20 events a ms, among noise that
/// comes and goes.
class Watched {
 public:
    Watched() {
        contour_.fit(Eigen::Matrix2d::Identity(), Clutter::far_to_px);
        clutter_.restart();
        clutter_.sample(contour_, Eigen::Matrix2d::Identity());
        watch_.restart(pose_of(150, 120, 0), {});
    }
    const NoiseWatch& watch() const { return watch_; }

    void go_on(double noise_hz, std::int64_t for_us) {
        constexpr double half_px = 60;
        const double noise_per_us = noise_hz * 4 * half_px * half_px * 1e-6;
        constexpr double own_per_us = 0.02;
        std::exponential_distribution<double> wait_us(noise_per_us + own_per_us);
        std::uniform_real_distribution<double> at_px(-half_px, half_px);
        std::bernoulli_distribution is_own(own_per_us / (noise_per_us + own_per_us));
        const double end_us = t_us_ + static_cast<double>(for_us);
        for (; t_us_ < end_us; t_us_ += wait_us(random_)) {
            const auto now_us = static_cast<std::int64_t>(t_us_);
            clutter_.reach(now_us);
            if (clutter_.asks_for_noise_of_us(now_us) > 0) clutter_.bound_noise(now_us, noise_hz);
            if (watch_.is_due(now_us)) {
                watch_.look({now_us, pose_of(150, 120, 0), {}}, clutter_, 1, contour_.gyration_px(),
                            contour_.radius_px());
            }
            if (is_own(random_)) {
                clutter_.count_near(0, 1);
                continue;
            }
            const ContourPlace place = place_on_contour<TransformKind::isometry>(
                contour_.pieces(), Eigen::Matrix2d::Identity(), {at_px(random_), at_px(random_)},
                Clutter::far_to_px);
            if (place.piece < 0) continue;
            if (std::abs(place.r_px) > Clutter::far_from_px) {
                clutter_.count_far(place.piece, place.r_px);
            } else if (std::abs(place.r_px) < 4) {
                clutter_.count_near(place.piece, 0.1);
            }
        }
    }

 private:
    std::mt19937 random_{1};
    Contour contour_{test::arrow()};
    Clutter clutter_;
    NoiseWatch watch_{contour_};
    double t_us_ = 0;
};

TEST(NoiseWatch, does_not_know_what_silence_means_in_noise_that_it_does_not_look_at) {
    Watched watched;
    watched.go_on(0.1, 600'000);
    EXPECT_TRUE(watched.watch().knows_silence());
    // The object has shown by then, so that it is left to the estimator.
    watched.go_on(8, 600'000);
    EXPECT_FALSE(watched.watch().is_on());
    EXPECT_FALSE(watched.watch().knows_silence());
    watched.go_on(0.1, 600'000);
    EXPECT_TRUE(watched.watch().knows_silence()) << "the noise is over";
}

/// The mean error, px, of an arrow among so much noise that stands at first, sets out and stops.
double mean_error_px(double noise_hz, const Eigen::Vector2d& start_off_px) {
    const auto truth = [](double t_us) {
        const double t_s = std::clamp(t_us * 1e-6 - 0.15, 0.0, 0.3);
        const double turned = t_s / 0.3;
        const double way_px = 36 * turned * turned * (3 - 2 * turned);  // up to 180 px/s
        return pose_of(130 + way_px, 120 - way_px / 3, 0.2 * turned);
    };
    const Shape shape = test::arrow();
    Pose start = truth(0);
    start.t_px += start_off_px;
    Tracker tracker = test::that_follows_an_arrow(start);
    test::Poses poses;
    tracker.process(outline_events(shape, truth, 0, 600'000, moving_per_ms, noise_per_ms(noise_hz),
                                   small_sensor, 7),
                    poses);
    double sum_px = 0;
    for (const auto& row : poses.rows) {
        sum_px += rms_px(shape, row.record.pose, truth(static_cast<double>(row.record.t_us)));
    }
    return sum_px / static_cast<double>(poses.rows.size());
}

TEST(NoiseWatch, keeps_an_object_that_stands_among_noise_and_sets_out) {
    EXPECT_LT(mean_error_px(30, {0.7, -0.7}), 1);
    EXPECT_LT(mean_error_px(100, {0.7, -0.7}), 1.2);
}

TEST(NoiseWatch, takes_an_object_up_that_stood_a_few_px_off) {
    EXPECT_LT(mean_error_px(100, {-3, 2}), 2.5);
}

TEST(NoiseWatch, goes_with_an_object_that_creeps) {
    const Shape shape = test::arrow();
    for (const double noise_hz : {5.0, 10.0, 100.0}) {
        const auto truth = [](double t_us) {
            return pose_of(120 + 25e-6 * t_us, 120, 0.3 + 0.3e-6 * t_us);
        };
        Pose start = truth(0);
        start.t_px += Eigen::Vector2d(0.7, -0.7);
        Tracker tracker = test::that_follows_an_arrow(start);
        test::Poses poses;
        tracker.process(outline_events(shape, truth, 0, 1'000'000, moving_per_ms,
                                       noise_per_ms(noise_hz), small_sensor, 9),
                        poses);
        EXPECT_LT(rms_px(shape, poses.rows.back().record.pose, truth(999'000)), 1) << noise_hz;
    }
}

TEST(NoiseWatch, keeps_an_object_that_creeps_where_the_edges_of_another_pass_it) {
    const Shape shape = test::arrow();
    const Shape wall = test::polygon("wall", {{-20, -60}, {20, -60}, {20, 60}, {-20, 60}});
    const auto truth = [](double t_us) { return pose_of(120 + 20e-6 * t_us, 120, 0.3); };
    const auto passing = [](double t_us) { return pose_of(60 + 80e-6 * t_us, 55, 0); };
    Tracker tracker = test::that_follows_an_arrow(truth(0));
    Registration other;
    other.shape = wall;
    other.estimator = EstimatorKind::kalman;
    other.start.pose = passing(0);
    ASSERT_TRUE(tracker.register_object(other));
    auto events = outline_events(shape, truth, 0, 2'000'000, moving_per_ms, noise_per_ms(15),
                                 small_sensor, 13);
    const auto of_wall =
        outline_events(wall, passing, 0, 2'000'000, 2 * moving_per_ms, 0, small_sensor, 14);
    events.insert(events.end(), of_wall.begin(), of_wall.end());
    std::stable_sort(events.begin(), events.end(),
                     [](const Event& l, const Event& r) { return l.t_us < r.t_us; });
    test::Poses poses;
    tracker.process(events, poses);
    for (const auto& row : poses.rows) {
        if (row.record.object_id != 1) continue;
        const auto t_us = static_cast<double>(row.record.t_us);
        ASSERT_LT(rms_px(shape, row.record.pose, truth(t_us)), 3) << t_us;
    }
}

TEST(NoiseWatch, keeps_what_goes_slowly_after_it_went_fast) {
    const Shape shape = test::arrow();
    const auto truth = [](double t_us) {
        const double slow_s = std::max(t_us * 1e-6 - 0.3, 0.0);
        const double fast_s = t_us * 1e-6 - slow_s;
        return pose_of(80 + 250 * fast_s + 15 * slow_s, 120, 0.3 + 0.6 * slow_s);
    };
    Tracker tracker = test::that_follows_an_arrow(truth(0));
    test::Poses poses;
    // Most of what is on its contour is noise from then on.
    tracker.process(outline_events(shape, truth, 0, 900'000, 2 * moving_per_ms, noise_per_ms(60),
                                   small_sensor, 12),
                    poses);
    for (const auto& row : poses.rows) {
        const auto t_us = static_cast<double>(row.record.t_us);
        EXPECT_EQ(row.record.state, TrackState::tracking) << t_us;
        EXPECT_LT(rms_px(shape, row.record.pose, truth(t_us)), 2) << t_us;
    }
}

TEST(NoiseWatch, takes_nothing_that_stood_out_before_a_silence_for_sure_after_it) {
    const Shape shape = test::arrow();
    const auto truth = [](double t_us) { return pose_of(60 + 180e-6 * t_us, 120, 0.3); };
    auto events =
        outline_events(shape, truth, 0, 700'000, moving_per_ms, noise_per_ms(30), small_sensor, 11);
    std::erase_if(events, [](const Event& e) { return e.t_us > 400'000 && e.t_us < 490'000; });
    Tracker tracker = test::that_follows_an_arrow(truth(0));
    test::Poses poses;
    tracker.process(events, poses);
    EXPECT_LT(rms_px(shape, poses.rows.back().record.pose, truth(699'000)), 1);
    for (const auto& row : poses.rows) {
        const auto t_us = static_cast<double>(row.record.t_us);
        if (rms_px(shape, row.record.pose, truth(t_us)) < 10) continue;
        EXPECT_LE(row.record.confidence, 0.5) << t_us;
    }
}

TEST(NoiseWatch, holds_an_object_that_stands_for_seconds) {
    const Shape shape = test::arrow();
    const Pose there = pose_of(150, 120, 0.3);
    Tracker tracker = test::that_follows_an_arrow(there);
    test::Poses poses;
    for (std::int64_t t_us = 0; t_us < 2'000'000; t_us += 100'000) {
        tracker.process(outline_events(
                            shape, [&](double) { return there; }, t_us, t_us + 100'000, 0,
                            noise_per_ms(60), small_sensor, static_cast<std::uint32_t>(t_us)),
                        poses);
    }
    EXPECT_LT(rms_px(shape, poses.rows.back().record.pose, there), 0.5);
    const auto is_off = [&](const auto& row) {
        return row.record.t_us > 30'000 && rms_px(shape, row.record.pose, there) > 0.5;
    };
    // By chance it may seem to be elsewhere for a moment.
    EXPECT_LT(std::count_if(poses.rows.begin(), poses.rows.end(), is_off),
              static_cast<std::ptrdiff_t>(poses.rows.size() / 100));
}

}  // namespace
}  // namespace pursuit::tracker
