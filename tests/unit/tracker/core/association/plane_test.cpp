// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/unit/tracker/core/edge_events.hpp"

namespace pursuit::tracker {
namespace {

constexpr double c_px_us = 1e-3;

TEST(Plane, of_an_edge_that_moves_evenly_is_as_computed_by_hand) {
    PlaneSums sums;
    for (const Event& event : test::edge_events(5000, 100)) sums.add(event.x, event.y, event.t_us);
    const auto plane = sums.fit(c_px_us, 105'000);
    ASSERT_TRUE(plane);
    const double sign = plane->normal.x() > 0 ? 1 : -1;
    EXPECT_NEAR(sign * plane->normal.x(), std::sqrt(0.5), 1e-9);
    EXPECT_NEAR(plane->normal.y(), 0, 1e-9);
    EXPECT_NEAR(sign * plane->normal.z(), -std::sqrt(0.5), 1e-9);
    // The edge is at 110 px now: on it, and 4 px ahead of it.
    EXPECT_NEAR(plane->distance_px(110, 7, 105'000), 0, 1e-9);
    EXPECT_NEAR(plane->distance_px(114, 7, 105'000), 4 * std::sqrt(0.5), 1e-9);
    EXPECT_NEAR(plane->distance_px(114, 7, 107'000), 2 * std::sqrt(0.5), 1e-9);
    EXPECT_DOUBLE_EQ(plane->sigma_px, std::sqrt(1.0 / 12));
}

TEST(Plane, has_the_spread_of_its_events) {
    PlaneSums sums;
    // Two upright edges 6 px apart: 3 px from the middle, across the plane 3/√2.
    for (const Event& event : test::edge_events(0, 100)) {
        sums.add(event.x, event.y, event.t_us);
        sums.add(static_cast<std::uint16_t>(event.x + 6), event.y, event.t_us);
    }
    EXPECT_NEAR(sums.fit(c_px_us, 100'000)->sigma_px, 3 * std::sqrt(0.5), 0.01);
}

TEST(Plane, is_none_of_fewer_than_three_events) {
    PlaneSums sums;
    EXPECT_FALSE(sums.fit(c_px_us, 0));
    sums.add(1, 2, 3);
    sums.add(2, 2, 3);
    EXPECT_FALSE(sums.fit(c_px_us, 0));
    sums.add(3, 7, 3);
    EXPECT_TRUE(sums.fit(c_px_us, 0));
}

TEST(Plane, is_the_same_to_the_bit_after_a_million_events_came_and_went_late_in_time) {
    constexpr std::int64_t late_us = std::int64_t{1} << 52;
    std::mt19937 random(1);
    PlaneSums sums;
    std::vector<Event> events;
    for (int i = 0; i < 1'000'000; ++i) {
        events.push_back({late_us + i, static_cast<std::uint16_t>(random() % 1280),
                          static_cast<std::uint16_t>(random() % 720), 1});
        sums.add(events.back().x, events.back().y, events.back().t_us);
        if (i < 1000) continue;
        const Event& gone = events[static_cast<std::size_t>(i) - 1000];
        sums.remove(gone.x, gone.y, gone.t_us);
    }
    PlaneSums afresh;
    for (std::size_t i = events.size() - 1000; i < events.size(); ++i) {
        // As if time had begun at the late time.
        afresh.add(events[i].x, events[i].y, events[i].t_us - late_us);
    }
    const auto plane = sums.fit(1e-3, late_us + 1'000'000);
    const auto expected = afresh.fit(1e-3, 1'000'000);
    EXPECT_EQ(sums.count(), 1000U);
    EXPECT_EQ(plane->normal, expected->normal);
    EXPECT_EQ(plane->centre_px, expected->centre_px);
    EXPECT_EQ(plane->sigma_px, expected->sigma_px);
}

TEST(Plane, keeps_its_precision_at_its_limits) {
    // 65,536 events over 10 s at the far corner of the largest array: the largest sums there are.
    PlaneSums sums;
    for (int i = 0; i < 65'536; ++i) {
        const auto y = static_cast<std::uint16_t>(65'535 - i * 7919 % 4096);
        sums.add(static_cast<std::uint16_t>(65'535 - i % 2), y,
                 10'000'000 * std::int64_t{i} / 65'536);
    }
    const auto plane = sums.fit(1e-3, 10'000'000);
    EXPECT_NEAR(std::abs(plane->normal.x()), 1, 1e-6);
    EXPECT_NEAR(plane->sigma_px, 0.5, 1e-3);
}

}  // namespace
}  // namespace pursuit::tracker
