// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/acquisition.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::small_sensor;

// On a disc, at 9000 px/s.
Pose circling(double t_us) {
    const double angle_rad = 300e-6 * t_us;
    return pose_of(152 + 30 * std::cos(angle_rad), 120 + 30 * std::sin(angle_rad), angle_rad + 1);
}

/// The arrow's events under these poses, each up to so much too late and off by a blur.
template <class PoseAt>
std::vector<Event> late_events(PoseAt pose_at, double late_us, double blur_px, std::uint32_t seed) {
    auto events =
        test::outline_events(test::arrow(), pose_at, 0, 6'000, 800, 5, small_sensor, seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> late(0, late_us);
    std::normal_distribution<double> off_px(0, blur_px);
    for (Event& event : events) {
        event.t_us += static_cast<std::int64_t>(late(random));
        event.x = static_cast<std::uint16_t>(std::lround(event.x + off_px(random)));
        event.y = static_cast<std::uint16_t>(std::lround(event.y + off_px(random)));
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const Event& l, const Event& r) { return l.t_us < r.t_us; });
    return events;
}

Acquisition follow(const Pose& start, const std::vector<Event>& events) {
    Acquisition acquisition(TransformKind::isometry, Contour(test::arrow()), {});
    acquisition.begin(start, 6);
    for (const Event& event : events) {
        if (acquisition.approach(event) != nullptr) acquisition.take();
    }
    return acquisition;
}

TEST(Acquisition, arrives_at_what_goes_fast_though_its_events_come_late_by_chance) {
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
        const Acquisition there = follow(circling(0), late_events(circling, 700, 1.2, seed));
        EXPECT_TRUE(there.is_done()) << seed;
        // A descent lags behind; what comes late moves it by little more than the mean delay does.
        const Acquisition exact = follow(circling(0), late_events(circling, 0, 0.1, seed));
        EXPECT_TRUE(exact.is_done()) << seed;
        EXPECT_LT(test::rms_px(test::arrow(), there.pose(), exact.pose()), 350e-6 * 9000 + 2)
            << seed;
    }
}

TEST(Acquisition, does_not_take_what_lies_that_far_off_for_its_own_when_it_stands) {
    // As wide about the contour as above, for another reason than being late.
    const auto trembling = [](double t_us) {
        const double phase = t_us * 0.05;
        return pose_of(152 + 4 * std::cos(phase), 120 + 4 * std::sin(1.7 * phase), 1);
    };
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
        EXPECT_FALSE(follow(pose_of(152, 120, 1), late_events(trembling, 0, 0.1, seed)).is_done())
            << seed;
    }
}

TEST(Acquisition, is_not_drawn_out_of_all_proportion_by_what_else_goes_by) {
    // A line that sweeps over the image, and noise.
    for (const TransformKind kind :
         {TransformKind::similarity, TransformKind::paper_affine, TransformKind::full_affine}) {
        const Pose start = pose_of(152, 120, 0.3, 1, kind == TransformKind::similarity ? 1 : 0.8);
        Acquisition acquisition(kind, Contour(test::ring("ring", 100, 32)), {});
        acquisition.begin(start);
        std::mt19937 random(1);
        for (std::int64_t t_us = 0; t_us < 60'000; t_us += 2) {
            Event event{t_us, static_cast<std::uint16_t>(random() % small_sensor.width),
                        static_cast<std::uint16_t>(random() % small_sensor.height), 1};
            if (t_us % 4 == 0) {
                event.x = static_cast<std::uint16_t>(t_us / 1000 % small_sensor.width);
            }
            if (acquisition.approach(event) != nullptr) acquisition.take();
            const Eigen::Matrix2d grown = acquisition.pose().a * start.a.inverse();
            const double most = largest_scale(grown);
            const double least = grown.determinant() / most;
            ASSERT_GT(least, 0.35) << to_string(kind) << " " << t_us;
            ASSERT_LT(most, 2.85) << to_string(kind) << " " << t_us;
            ASSERT_LT(most / least, 2.01) << to_string(kind) << " " << t_us;
        }
    }
}

TEST(Acquisition, is_not_done_among_noise_alone) {
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
        const auto noise =
            test::outline_events(test::arrow(), circling, 0, 50'000, 0, 200, small_sensor, seed);
        EXPECT_FALSE(follow(pose_of(152, 120, 1), noise).is_done()) << seed;
    }
}

}  // namespace
}  // namespace pursuit::tracker
