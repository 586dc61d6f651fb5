// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose_grid.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace pursuit::tracker {
namespace {

constexpr double rate_hz = 1000;
constexpr std::int64_t first_us = 12'345;
constexpr std::int64_t second_us = 1'000'000;

/// How many grid times there are until `end_us`, and for how many of them each of `objects` is due.
struct Due {
    std::size_t times = 0;
    std::vector<std::size_t> by_object;
};

Due due_until(PoseGrid& grid, std::int64_t end_us, std::size_t objects) {
    Due due{0, std::vector<std::size_t>(objects)};
    for (; grid.next_us() < end_us; grid.step(), ++due.times) {
        for (std::size_t i = 0; i < objects; ++i) {
            due.by_object[i] += grid.is_due(static_cast<std::uint32_t>(i + 1), objects) ? 1 : 0;
        }
    }
    return due;
}

/// At the first grid time that a silence has thinned to 10 Hz.
PoseGrid silent_grid(double max_poses_per_s) {
    PoseGrid grid(rate_hz, max_poses_per_s);
    grid.event_at(first_us);
    while (grid.next_us() <= first_us + second_us) grid.step();
    return grid;
}

TEST(PoseGrid, in_a_silence_gives_every_object_every_pose_where_the_cap_allows_it) {
    for (const auto& [objects, cap] : {std::pair{2, 1000.0}, {20, 1e4}, {50, 1e4}, {100, 1e4}}) {
        PoseGrid grid = silent_grid(cap);
        const Due due = due_until(grid, 120 * second_us, static_cast<std::size_t>(objects));
        EXPECT_EQ(due.times, 590U + 60U);
        for (const std::size_t poses : due.by_object) EXPECT_EQ(poses, due.times) << objects;
    }
}

TEST(PoseGrid, in_a_silence_gives_every_object_its_even_share_of_a_lower_cap) {
    // Of 10 Hz a quarter, and of 1 Hz all.
    PoseGrid grid = silent_grid(100);
    const Due thinned = due_until(grid, first_us + 60 * second_us, 40);
    EXPECT_EQ(thinned.times, 590U);
    for (const std::size_t poses : thinned.by_object)
        EXPECT_NEAR(static_cast<double>(poses), 590 / 4.0, 1);
    const Due slow = due_until(grid, 200 * second_us, 40);
    // (The first of these is one of 10 Hz still.)
    for (const std::size_t poses : slow.by_object) EXPECT_GE(poses + 1, slow.times);
}

TEST(PoseGrid, after_a_silence_shares_the_whole_grid_evenly_again) {
    PoseGrid grid = silent_grid(1e4);
    while (grid.next_us() < 30 * second_us) grid.step();
    for (std::int64_t t_us = 30 * second_us; t_us < 31 * second_us; t_us += 500) {
        while (grid.next_us() <= t_us) grid.step();
        grid.event_at(t_us);
    }
    const Due due = due_until(grid, grid.next_us() + second_us / 2, 50);
    EXPECT_EQ(due.times, 500U);
    for (const std::size_t poses : due.by_object)
        EXPECT_NEAR(static_cast<double>(poses), 500 / 5.0, 1);
}

TEST(PoseGrid, is_thinned_alike_wherever_it_begins_in_a_stream_without_silences) {
    PoseGrid whole(rate_hz, 1e4);
    PoseGrid later(rate_hz, 1e4);
    whole.event_at(first_us);
    while (whole.next_us() < second_us / 2) whole.step();
    later.event_at(second_us / 2 - 1);
    for (; later.next_us() < second_us; whole.step(), later.step()) {
        ASSERT_EQ(whole.next_us(), later.next_us());
        for (std::uint32_t id = 1; id <= 50; ++id) {
            EXPECT_EQ(whole.is_due(id, 50), later.is_due(id, 50));
        }
    }
}

TEST(PoseGrid, makes_a_second_of_its_rate_and_4130_times_more_at_most_in_a_jump_of_time) {
    for (const double hz : {1.0, 15.0, 1000.0, 1e4, 1e5}) {
        PoseGrid grid(hz, 1e6);
        grid.event_at(5);
        const Due due = due_until(grid, PoseGrid::none, 1);
        EXPECT_LE(due.times, static_cast<std::size_t>(hz) + 4130);
        EXPECT_EQ(grid.next_us(), PoseGrid::none);
    }
}

}  // namespace
}  // namespace pursuit::tracker
