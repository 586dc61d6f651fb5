// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/noise_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "services/tracker/core/geometry/contour_place.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow_per_ms;
using test::noise_per_ms;
using test::outline_events;
using test::rms_px;
using test::small_sensor;

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
    tracker.process(outline_events(shape, truth, 0, 600'000, arrow_per_ms, noise_per_ms(noise_hz),
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
        tracker.process(outline_events(shape, truth, 0, 1'000'000, arrow_per_ms,
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
    auto events = outline_events(shape, truth, 0, 2'000'000, arrow_per_ms, noise_per_ms(15),
                                 small_sensor, 13);
    const auto of_wall =
        outline_events(wall, passing, 0, 2'000'000, 2 * arrow_per_ms, 0, small_sensor, 14);
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
    tracker.process(outline_events(shape, truth, 0, 900'000, 2 * arrow_per_ms, noise_per_ms(60),
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
        outline_events(shape, truth, 0, 700'000, arrow_per_ms, noise_per_ms(30), small_sensor, 11);
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
