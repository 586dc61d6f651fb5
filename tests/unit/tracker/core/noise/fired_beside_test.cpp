// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/fired_beside.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <vector>

namespace pursuit::tracker {
namespace {

constexpr unsigned image_side = 101;
constexpr FiredBox whole{-1, image_side, -1, image_side};
const Eigen::Vector2d middle_px(50, 50);
constexpr double all_px = 100;

/// Counts of each pixel, spread by 1 2 1 across and down.
class Beside : public testing::Test {
 protected:
    Beside() { beside_.begin(image_side); }

    void fire(int column, int row, double events = 1) {
        for (int y = -1; y <= 1; ++y) {
            for (int x = -1; x <= 1; ++x) {
                const double share = (x == 0 ? 2 : 1) * (y == 0 ? 2 : 1) / 16.0;
                counts_.at(static_cast<std::size_t>((row + y) * int{image_side} + column + x)) +=
                    static_cast<float>(events * share);
            }
        }
    }
    /// Noise that brings so many events a pixel.
    void fire_everywhere(double events_per_pixel) {
        std::mt19937 random(5);
        const auto events = static_cast<int>(events_per_pixel * image_side * image_side);
        for (int i = 0; i < events; ++i) {
            const auto column = static_cast<int>(1 + random() % (image_side - 2));
            const auto row = static_cast<int>(1 + random() % (image_side - 2));
            fire(column, row);
        }
    }
    double unevenness(double radius_px = all_px, const FiredBox& seen = whole) {
        beside_.add(counts_);
        return beside_.unevenness(middle_px, radius_px, seen);
    }

    FiredBeside beside_;
    std::vector<float> counts_ = std::vector<float>(std::size_t{image_side} * image_side);
};

TEST_F(Beside, noise_alone_is_even_however_strong) {
    for (const double events_per_pixel : {0.1, 1.0, 3.0}) {
        beside_.begin(image_side);
        counts_.assign(counts_.size(), 0);
        fire_everywhere(events_per_pixel);
        EXPECT_NEAR(unevenness(48), 1, 0.15) << events_per_pixel;
    }
}

TEST_F(Beside, an_edge_among_noise_is_not_unless_it_is_of_the_contour) {
    fire_everywhere(0.1);
    for (int row = 10; row < 90; ++row) fire(30, row, 3);
    EXPECT_GT(unevenness(48), 2);
    for (int row = 10; row < 90; ++row) beside_.leave_out({30, row});
    EXPECT_NEAR(beside_.unevenness(middle_px, 48, whole), 1, 0.15);
}

TEST_F(Beside, what_is_farther_away_or_where_no_events_come_from_does_not_count) {
    fire_everywhere(0.1);
    for (int row = 10; row < 90; ++row) fire(10, row, 3);
    EXPECT_NEAR(unevenness(36), 1, 0.15);
    EXPECT_GT(beside_.unevenness(middle_px, all_px, whole), 2);
    EXPECT_NEAR(beside_.unevenness(middle_px, 48, {12, image_side, -1, image_side}), 1, 0.15);
}

TEST_F(Beside, where_nothing_fired_or_nothing_is_left_it_is_even) {
    EXPECT_EQ(unevenness(), 1);
    fire(50, 50, 3);
    EXPECT_GT(unevenness(), 1.5);
    for (int row = 0; row < int{image_side}; row += 3) {
        for (int column = 0; column < int{image_side}; column += 3)
            beside_.leave_out({column, row});
    }
    EXPECT_EQ(beside_.unevenness(middle_px, all_px, whole), 1);
}

TEST_F(Beside, what_is_left_out_may_reach_beyond_the_window) {
    fire_everywhere(0.1);
    for (int row = 10; row < 90; ++row) {
        for (const int column : {2, 98}) fire(column, row, 3);
    }
    beside_.add(counts_);
    for (const double far_px : {-1e6, -5.0, 105.0, 1e6}) {
        for (int at = 0; at < int{image_side}; ++at) {
            beside_.leave_out({far_px, at});
            beside_.leave_out({at, far_px});
        }
    }
    EXPECT_GT(beside_.unevenness(middle_px, all_px, whole), 2) << "nothing in it is left out";
    for (int row = 0; row < int{image_side}; ++row) {
        beside_.leave_out({1, row});
        beside_.leave_out({99, row});
    }
    EXPECT_NEAR(beside_.unevenness(middle_px, 60, whole), 1, 0.15);
}

}  // namespace
}  // namespace pursuit::tracker
