// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/leads/edge_contrast.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

constexpr int polarity_on = 1;
constexpr double of_traffic_px_s = 40;

/// Edges that make 2 and 5 events in each of so many pixels.
EdgeContrast of_a_weak_and_a_strong_edge(int pixels) {
    EdgeContrast contrast;
    contrast.restart(3);
    for (int pixel = 0; pixel < pixels; ++pixel) {
        for (int i = 0; i < 2; ++i) contrast.count(0, polarity_on, i > 0, 1);
        for (int i = 0; i < 5; ++i) contrast.count(1, polarity_on, i > 0, 1);
    }
    return contrast;
}

double earlier_at(double speed_px_s, EdgeContrast contrast, std::int32_t piece, int polarity) {
    contrast.set_speed(speed_px_s);
    return contrast.earlier(piece, polarity);
}

TEST(EdgeContrast, has_the_events_of_strong_edges_earlier_and_those_of_weak_ones_later) {
    const EdgeContrast contrast = of_a_weak_and_a_strong_edge(50'000);
    // Shares 1/2 and 4/5 of subsequent events, 5/7 of all: of it, 3/2 of the way between the leads.
    EXPECT_NEAR(earlier_at(0, contrast, 0, polarity_on), 1.5 * (1.0 / 2 - 5.0 / 7), 0.02);
    EXPECT_NEAR(earlier_at(0, contrast, 1, polarity_on), 1.5 * (4.0 / 5 - 5.0 / 7), 0.02);
}

TEST(EdgeContrast, says_nothing_of_an_edge_without_events_and_little_after_a_few) {
    EXPECT_EQ(earlier_at(of_traffic_px_s, of_a_weak_and_a_strong_edge(1000), 2, polarity_on), 0);
    EdgeContrast contrast = of_a_weak_and_a_strong_edge(1000);
    contrast.count(2, polarity_on, true, 1);
    EXPECT_GT(earlier_at(of_traffic_px_s, contrast, 2, polarity_on), 0);
    EXPECT_LT(earlier_at(of_traffic_px_s, contrast, 2, polarity_on), 0.02);
}

TEST(EdgeContrast, finds_nothing_where_all_edges_are_alike) {
    EdgeContrast contrast;
    contrast.restart(2);
    for (int i = 0; i < 3000; ++i) {
        for (int piece = 0; piece < 2; ++piece) contrast.count(piece, polarity_on, i % 3 > 0, 1);
    }
    EXPECT_NEAR(earlier_at(of_traffic_px_s, contrast, 0, polarity_on), 0, 0.01);
    EXPECT_NEAR(earlier_at(of_traffic_px_s, contrast, 1, polarity_on), 0, 0.01);
}

TEST(EdgeContrast, is_of_each_polarity_by_itself) {
    EdgeContrast contrast;
    contrast.restart(2);
    // OFF events come alone, ON events in threes: the edges are no different for that.
    for (int i = 0; i < 3000; ++i) {
        contrast.count(0, 0, false, 1);
        contrast.count(1, polarity_on, i % 3 > 0, 1);
    }
    EXPECT_NEAR(earlier_at(of_traffic_px_s, contrast, 0, 0), 0, 0.01);
    EXPECT_NEAR(earlier_at(of_traffic_px_s, contrast, 1, polarity_on), 0, 0.01);
}

TEST(EdgeContrast, counts_less_the_faster_the_object_is) {
    const EdgeContrast contrast = of_a_weak_and_a_strong_edge(1000);
    EXPECT_GT(earlier_at(40, contrast, 1, polarity_on),
              0.95 * earlier_at(0, contrast, 1, polarity_on));
    EXPECT_LT(earlier_at(3000, contrast, 1, polarity_on),
              0.02 * earlier_at(0, contrast, 1, polarity_on));
}

TEST(EdgeContrast, forgets_what_was_long_ago) {
    EdgeContrast contrast;
    contrast.restart(2);
    for (int i = 0; i < 20'000; ++i) {
        contrast.count(0, polarity_on, i < 10'000, 1);
        contrast.count(1, polarity_on, i % 2 == 0, 1);
    }
    EXPECT_LT(earlier_at(of_traffic_px_s, contrast, 0, polarity_on), -0.3);
}

TEST(EdgeContrast, knows_nothing_after_a_restart) {
    EdgeContrast contrast = of_a_weak_and_a_strong_edge(1000);
    contrast.restart(3);
    EdgeContrast fresh;
    fresh.restart(3);
    EXPECT_EQ(earlier_at(of_traffic_px_s, contrast, 0, polarity_on), 0);
    for (EdgeContrast* one : {&contrast, &fresh}) {
        for (int i = 0; i < 10; ++i) one->count(i % 2, polarity_on, i > 5, 1);
    }
    EXPECT_EQ(earlier_at(of_traffic_px_s, contrast, 0, polarity_on),
              earlier_at(of_traffic_px_s, fresh, 0, polarity_on));
    EXPECT_EQ(earlier_at(of_traffic_px_s, contrast, 1, polarity_on),
              earlier_at(of_traffic_px_s, fresh, 1, polarity_on));
}

}  // namespace
}  // namespace pursuit::tracker
