// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/geometry/reach_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::small_sensor;

std::vector<std::size_t> asked(const ReachMap& map, std::uint16_t x, std::uint16_t y) {
    std::vector<std::size_t> indices;
    map.at(x, y).for_each([&](std::size_t i) { indices.push_back(i); });
    return indices;
}

bool is_asked(const ReachMap& map, std::size_t index, std::uint16_t x, std::uint16_t y) {
    const auto indices = asked(map, x, y);
    return std::find(indices.begin(), indices.end(), index) != indices.end();
}

TEST(ReachMap, asks_nobody_where_nobody_was_placed) {
    ReachMap map;
    map.restart(small_sensor, 3);
    EXPECT_TRUE(asked(map, 0, 0).empty());
    EXPECT_TRUE(asked(map, 303, 239).empty());
}

TEST(ReachMap, asks_everybody_whose_reach_a_pixel_is_in_as_they_move_and_grow) {
    ReachMap map;
    constexpr std::size_t objects = 256;
    map.restart(small_sensor, objects);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> x(-60, 364);
    std::uniform_real_distribution<double> y(-60, 300);
    std::uniform_real_distribution<double> radius(0, 50);
    std::uniform_real_distribution<double> step(-6, 6);
    std::vector<Reach> reaches(objects);
    for (auto& reach : reaches) reach = {{x(random), y(random)}, radius(random)};
    std::uniform_int_distribution<int> column(0, small_sensor.width - 1);
    std::uniform_int_distribution<int> row(0, small_sensor.height - 1);
    for (int round = 0; round < 40; ++round) {
        for (std::size_t i = 0; i < objects; ++i) {
            map.place(i, reaches[i]);
        }
        for (int pixel = 0; pixel < 50; ++pixel) {
            const auto px = static_cast<std::uint16_t>(column(random));
            const auto py = static_cast<std::uint16_t>(row(random));
            const auto indices = asked(map, px, py);
            EXPECT_TRUE(std::is_sorted(indices.begin(), indices.end()));
            const auto some = map.at(px, py).some();
            EXPECT_EQ(some.count, indices.size());
            if (indices.size() == 1) {
                EXPECT_EQ(some.sole, indices.front());
            }
            for (std::size_t i = 0; i < objects; ++i) {
                const double away_px = (reaches[i].center_px - Eigen::Vector2d(px, py)).norm();
                if (away_px <= reaches[i].radius_px) {
                    EXPECT_TRUE(std::binary_search(indices.begin(), indices.end(), i));
                    EXPECT_TRUE(map.reaches(i, px, py));
                } else if (away_px > 1.5 * (reaches[i].radius_px + 80)) {
                    EXPECT_FALSE(std::binary_search(indices.begin(), indices.end(), i));
                }
            }
        }
        for (auto& reach : reaches) {
            reach.center_px += Eigen::Vector2d(step(random), step(random));
            reach.radius_px = std::max(reach.radius_px + step(random), 0.0);
        }
    }
}

TEST(ReachMap, asks_an_object_no_more_that_is_nowhere) {
    ReachMap map;
    map.restart(small_sensor, 1);
    map.place(0, {{100, 100}, 20});
    EXPECT_TRUE(is_asked(map, 0, 110, 100));
    map.place(0, {});
    EXPECT_FALSE(is_asked(map, 0, 110, 100));
}

TEST(ReachMap, asks_an_object_everywhere_whose_reach_is_without_end) {
    ReachMap map;
    map.restart(small_sensor, 2);
    map.place(1, {{100, 100}, std::numeric_limits<double>::infinity()});
    EXPECT_TRUE(is_asked(map, 1, 0, 0));
    EXPECT_TRUE(is_asked(map, 1, 303, 239));
}

/// Of a hundred objects the fourth is placed.
ReachMap crowded() {
    ReachMap map;
    map.restart(small_sensor, 100);
    map.place(3, {{100, 100}, 20});
    return map;
}

TEST(ReachMap, of_many_objects_tells_of_each_place_in_a_cell_whether_one_reaches_it) {
    const ReachMap map = crowded();
    // With what is left for its moves, 22 px.
    EXPECT_TRUE(map.reaches(3, 121, 100));
    EXPECT_FALSE(map.reaches(3, 123, 100));
    EXPECT_FALSE(map.reaches(3, 125, 120));
    EXPECT_TRUE(is_asked(map, 3, 125, 120));
    EXPECT_FALSE(map.reaches(4, 100, 100));
}

TEST(ReachMap, of_many_objects_knows_at_once_how_one_has_moved) {
    ReachMap map = crowded();
    map.place(3, {{104, 100}, 20});
    EXPECT_TRUE(map.reaches(3, 125, 100));
    EXPECT_FALSE(map.reaches(3, 81, 100));
}

TEST(ReachMap, asks_an_object_that_may_be_elsewhere_in_all_of_its_cells) {
    ReachMap map = crowded();
    EXPECT_FALSE(map.reaches(3, 125, 120));
    map.place(3, {{100, 100}, 20, true});
    EXPECT_TRUE(map.reaches(3, 125, 120));
    map.place(3, {{100, 100}, 20, false});
    EXPECT_FALSE(map.reaches(3, 125, 120));
}

TEST(ReachMap, of_many_objects_asks_one_that_may_be_elsewhere_farther_about_at_once) {
    ReachMap map = crowded();
    EXPECT_FALSE(is_asked(map, 3, 128, 100));
    map.place(3, {{100, 100}, 20, true});
    EXPECT_TRUE(is_asked(map, 3, 128, 100));
    map.place(3, {{100, 100}, 20, false});
    EXPECT_FALSE(is_asked(map, 3, 128, 100));
}

TEST(ReachMap, asks_each_of_a_few_objects_in_all_of_its_cells) {
    ReachMap map;
    map.restart(small_sensor, 2);
    map.place(1, {{100, 100}, 20});
    EXPECT_TRUE(map.reaches(1, 125, 120));
}

TEST(ReachMap, takes_a_place_that_is_no_number_for_nowhere) {
    ReachMap map;
    map.restart(small_sensor, 1);
    map.place(0, {{100, 100}, 20});
    map.place(0, {{std::numeric_limits<double>::quiet_NaN(), 100}, 20});
    EXPECT_FALSE(is_asked(map, 0, 100, 100));
}

}  // namespace
}  // namespace pursuit::tracker
