// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/clutter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "services/tracker/core/geometry/contour_place.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

TEST(Clutter, is_near_nothing_for_an_object_alone_and_high_in_noise) {
    Contour contour{test::arrow()};
    contour.fit(Eigen::Matrix2d::Identity(), 8);
    Clutter clutter;
    clutter.restart();
    clutter.sample(contour, Eigen::Matrix2d::Identity());
    for (int i = 0; i < 3000; ++i) clutter.count_near(0, 1);
    EXPECT_LT(clutter.density(0, 1), 0.01);
    EXPECT_GT(clutter.own_share(), 0.95);
    // As many beside the contour, over 2 × 3 px, as on it, over 2 × 4: most on it is clutter too.
    for (int i = 0; i < 6000; ++i) {
        clutter.count_near(0, 0.3);
        clutter.count_far(0, i % 2 == 0 ? 5 : -5);
    }
    EXPECT_GT(clutter.density(0, 1), 0.2);
    EXPECT_LT(clutter.own_share(), 0.3);
}

/// The pixels about it tell of most_hz.
struct Noise {
    double hz = 50;
    double own_hz = 0;       ///< Events on the contour beside the noise, …
    double own_from_us = 0;  ///< … from then on.
    double most_hz = 1000;
};

/// Noise about the contour until a time.
Clutter in_noise(const Noise& noise, double until_us) {
    constexpr double half_px = 80;
    const double noise_hz = noise.hz * 4 * half_px * half_px;
    Contour contour{test::arrow()};
    contour.fit(Eigen::Matrix2d::Identity(), 8);
    Clutter clutter;
    clutter.restart();
    clutter.sample(contour, Eigen::Matrix2d::Identity());
    std::mt19937 random(1);
    std::exponential_distribution<double> wait_us(1e-6);
    std::uniform_real_distribution<double> at_px(-half_px, half_px);
    double next_own_us = noise.own_from_us;
    double next_us = 0;
    for (double t_us = 0; t_us < until_us;) {
        const bool is_own = noise.own_hz > 0 && next_own_us < next_us;
        t_us = is_own ? next_own_us : next_us;
        (is_own ? next_own_us : next_us) += wait_us(random) / (is_own ? noise.own_hz : noise_hz);
        const auto now_us = static_cast<std::int64_t>(t_us);
        const ContourPlace place = place_on_contour<TransformKind::isometry>(
            contour.pieces(), Eigen::Matrix2d::Identity(), {at_px(random), at_px(random)},
            Clutter::far_to_px);
        if (!is_own && place.piece < 0) continue;
        clutter.reach(now_us);
        if (clutter.asks_for_noise_of_us(now_us) > 0) clutter.bound_noise(now_us, noise.most_hz);
        if (!is_own && std::abs(place.r_px) > Clutter::far_from_px) {
            clutter.count_far(place.piece, place.r_px);
        }
        if (is_own || std::abs(place.r_px) < Clutter::near_px) clutter.pass_near();
    }
    return clutter;
}

Clutter in_steady_noise(double most_hz) { return in_noise({.hz = 50, .most_hz = most_hz}, 400e3); }

TEST(Clutter, can_be_noise_as_long_as_little_comes_and_on_the_contour_no_more_than_beside_it) {
    for (const double hz : {0.02, 0.1, 0.5, 1.0, 2.0}) {
        EXPECT_TRUE(in_noise({.hz = hz}, 1e6).can_be_weak_noise()) << hz;
        // As soon as the arrow goes 50 px/s: 100 events a px of its way across itself and more.
        const Noise goes{.hz = hz, .own_hz = 5000, .own_from_us = 1e6};
        EXPECT_FALSE(in_noise(goes, 1.05e6).can_be_weak_noise()) << hz;
        EXPECT_FALSE(in_noise(goes, 2e6).can_be_weak_noise()) << hz;
    }
    EXPECT_FALSE(in_noise({.hz = 20}, 1e6).can_be_weak_noise());
}

TEST(Clutter, is_told_by_no_pixel_that_fires_by_itself) {
    EXPECT_TRUE(in_noise({.hz = 0.02, .own_hz = 50}, 3e6).can_be_weak_noise());
}

TEST(Clutter, takes_for_noise_what_is_steady_and_comes_from_everywhere) {
    EXPECT_TRUE(in_steady_noise(50).is_steady());
}

TEST(Clutter, takes_nothing_for_noise_that_the_other_pixels_do_not_make) {
    EXPECT_FALSE(in_steady_noise(5).is_steady());
}

TEST(Clutter, tells_the_noise_that_is_counted_and_no_more_than_the_other_pixels_show) {
    EXPECT_NEAR(in_steady_noise(1000).noise_hz(), 50, 10);
    const Clutter clutter = in_steady_noise(30);
    EXPECT_TRUE(clutter.is_steady());
    EXPECT_EQ(clutter.noise_hz(), 30);
}

}  // namespace
}  // namespace pursuit::tracker
