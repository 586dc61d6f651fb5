// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pixels/chance_support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pursuit::tracker {
namespace {

constexpr int width_px = 160;
constexpr int height_px = 96;
constexpr double over_us = 20'000;
constexpr double within_us = 5'000;
constexpr double third = 0.3;

/// Pixels from this column on fire by chance, so often each.
void add_noise(ChanceSupport& chance, double hz, int from_column) {
    std::mt19937 random(1);
    const double share = 1 - std::exp(-hz * over_us * 1e-6);
    for (int y = 0; y < height_px; ++y) {
        for (int x = from_column; x < width_px; ++x) {
            if (static_cast<double>(random()) / 4294967296.0 < share) chance.add(x, y);
        }
    }
}

int least_neighbours(double hz, int from_column = 0, double by_chance = third) {
    ChanceSupport chance;
    chance.begin(width_px, height_px);
    add_noise(chance, hz, from_column);
    return chance.least_neighbours(over_us, within_us, by_chance);
}

TEST(ChanceSupport, wants_more_neighbours_the_more_noise_there_is) {
    EXPECT_EQ(least_neighbours(0), 1);
    EXPECT_EQ(least_neighbours(4), 1);
    EXPECT_EQ(least_neighbours(15), 2);
    EXPECT_EQ(least_neighbours(40), 3);
    EXPECT_GE(least_neighbours(100), 4);
}

TEST(ChanceSupport, wants_more_neighbours_where_less_may_have_them_by_chance) {
    EXPECT_EQ(least_neighbours(0, 0, 0.1), 1);
    EXPECT_EQ(least_neighbours(4, 0, 0.1), 2);
    EXPECT_EQ(least_neighbours(40, 0, 0.1), 4);
}

TEST(ChanceSupport, takes_what_fires_in_a_part_of_the_image_for_no_noise) {
    EXPECT_EQ(least_neighbours(100, width_px * 2 / 5), 1);
}

TEST(ChanceSupport, wants_all_neighbours_where_all_surely_fire) {
    ChanceSupport chance;
    chance.begin(width_px, height_px);
    for (int y = 0; y < height_px; ++y) {
        for (int x = 0; x < width_px; ++x) chance.add(x, y);
    }
    for (const double times : {2, 8, 100}) {
        EXPECT_EQ(chance.least_neighbours(over_us, times * over_us, third), 8) << times;
    }
}

TEST(ChanceSupport, tells_nothing_of_a_small_box) {
    ChanceSupport chance;
    chance.begin(40, 40);
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 40; ++x) chance.add(x, y);
    }
    EXPECT_EQ(chance.least_neighbours(over_us, within_us, third), 1);
}

TEST(ChanceSupport, takes_a_box_where_all_has_fired) {
    ChanceSupport chance;
    chance.begin(width_px, height_px);
    for (int y = 0; y < height_px; ++y) {
        for (int x = 0; x < width_px; ++x) chance.add(x, y);
    }
    const int least = chance.least_neighbours(over_us, within_us, third);
    EXPECT_GT(least, 1);
    EXPECT_LE(least, 8);
}

}  // namespace
}  // namespace pursuit::tracker
