// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/most_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pursuit::tracker {
namespace {

constexpr Geometry small_image{200, 160};
constexpr double noise_extent_px = 30;
const Eigen::Vector2d noise_place_px(100, 80);

class MostNoise : public testing::Test {
 protected:
    MostNoise() { pixels_.restart(small_image); }

    /// Noise of all pixels, for 200 ms.
    void fire(double hz) {
        std::mt19937 random(1);
        const double each_us = 1e6 / (hz * small_image.width * small_image.height);
        for (double t_us = 0; t_us < 200e3; t_us += each_us) {
            pixels_.note({static_cast<std::int64_t>(t_us),
                          static_cast<std::uint16_t>(random() % small_image.width),
                          static_cast<std::uint16_t>(random() % small_image.height), 1});
        }
    }

    RecentPixels pixels_;
};

TEST_F(MostNoise, is_the_noise_that_there_is) {
    fire(10);
    EXPECT_NEAR(most_noise_hz(200'000, 100'000, noise_place_px, noise_extent_px, pixels_), 10, 1.5);
    EXPECT_NEAR(most_noise_hz(200'000, 20'000, noise_place_px, noise_extent_px, pixels_), 10, 2.5);
}

TEST_F(MostNoise, is_little_however_much_comes_from_a_line) {
    // An edge 60 px long, that comes to a stand and flickers: of all these pixels 13 Hz each.
    for (std::int64_t t_us = 0; t_us < 200'000; t_us += 1000) {
        for (std::uint16_t y = 50; y < 110; ++y) {
            pixels_.note({t_us, static_cast<std::uint16_t>(100 + t_us / 50'000), y, 1});
        }
    }
    EXPECT_LT(most_noise_hz(200'000, 100'000, noise_place_px, noise_extent_px, pixels_), 0.5);
}

TEST_F(MostNoise, is_not_bounded_where_next_to_nothing_of_it_lies_in_the_image) {
    fire(10);
    EXPECT_TRUE(std::isinf(most_noise_hz(200'000, 100'000, {-80, -70}, noise_extent_px, pixels_)));
}

}  // namespace
}  // namespace pursuit::tracker
