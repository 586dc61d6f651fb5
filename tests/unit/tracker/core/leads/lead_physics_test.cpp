// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/leads/lead_physics.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/leads/edge_passage.hpp"
#include "services/tracker/core/pixels/refractory.hpp"

namespace pursuit::tracker {
namespace {

TEST(EdgePassage,
     of_a_low_threshold_makes_as_many_events_as_it_has_steps_on_both_sides_of_the_edge) {
    const EdgePassage passage = pass_edge(2, 0.2, 0);
    EXPECT_NEAR(passage.events(0) + passage.events(1), 10, 1);
    EXPECT_NEAR(passage.events(2) + passage.events(3), 10, 1);
    EXPECT_NEAR(passage.subsequent_share(1), 0.9, 0.02);
    // The first ones come before the edge, and in the mean of all it is half a step behind it.
    EXPECT_GT(passage.ahead(0), 0.3);
    EXPECT_GT(passage.ahead(2), 1);
    EXPECT_NEAR(passage.common(), -0.2, 0.05);
}

TEST(EdgePassage, of_a_high_threshold_makes_one_event_behind_the_edge) {
    const EdgePassage passage = pass_edge(2, 1.2, 3);
    EXPECT_NEAR(passage.events.sum(), 2, 0.1);
    EXPECT_LT(passage.common(), -0.2);
}

TEST(EdgePassage, of_pixels_that_are_blind_while_it_passes_leaves_the_first_events_alone) {
    const EdgePassage passage = pass_edge(2, 0.2, 8);
    EXPECT_EQ(passage.events(1) + passage.events(3), 0);
    EXPECT_GT(passage.common(), 1);
}

/// What is seen of events of this sensor, whose edges pass at one speed, at a blur of 0.58 px.
LeadPhysics::Seen seen_of(const EdgePassage& passage, double blind_px) {
    LeadPhysics::Seen seen;
    seen.off_subsequent = passage.subsequent_share(0);
    seen.on_subsequent = passage.subsequent_share(1);
    // Wherever the edges are thought to be.
    seen.lead_px = 0.58 * passage.ahead.array() + 0.3;
    seen.blind_px = blind_px;
    return seen;
}

TEST(LeadPhysics, tells_how_far_ahead_events_come_from_how_many_there_are_and_how_far_apart) {
    for (const double threshold : {0.15, 0.3, 0.6, 0.9}) {
        const EdgePassage passage = pass_edge(2, threshold, 0);
        const auto told = LeadPhysics::tell(seen_of(passage, 0.05));
        EXPECT_NEAR(told.common_px, 0.58 * passage.common(), 0.08) << threshold;
        EXPECT_NEAR(told.apart_px, 0.58 * passage.apart(), 0.15) << threshold;
    }
}

TEST(LeadPhysics, tells_few_events_for_a_high_threshold_from_few_for_blind_pixels) {
    LeadPhysics::Seen seen;
    seen.off_subsequent = seen.on_subsequent = 0.23;
    seen.lead_px << -0.59, -1.14, 0.13, -0.56;
    seen.blind_px = 0.1;
    EXPECT_NEAR(LeadPhysics::tell(seen).common_px, -0.37, 0.1);
    seen.lead_px << 0.23, -0.88, 0.88, -0.24;
    seen.blind_px = 2.3;
    EXPECT_NEAR(LeadPhysics::tell(seen).common_px, 0.30, 0.1);
}

TEST(LeadPhysics, is_unsure_where_one_event_comes_and_pixels_are_blind_for_long) {
    LeadPhysics::Seen seen;
    seen.lead_px << 0, -0.5, 0.6, 0;
    seen.blind_px = 20;
    const double long_sigma_px = LeadPhysics::tell(seen).common_sigma_px;
    seen.blind_px = 0;
    EXPECT_LT(LeadPhysics::tell(seen).common_sigma_px, 0.7 * long_sigma_px);
    EXPECT_GT(long_sigma_px, 0.15);
}

TEST(Refractory, is_little_longer_than_the_shortest_of_many_intervals) {
    Refractory refractory;
    for (int i = 0; i < 200'000; ++i) refractory.see(i % 20 == 0 ? 900 + i % 100 : 40'000);
    EXPECT_NEAR(refractory.period_us(), 910, 40);
    // A single one that is shorter does not count: stamps jitter.
    refractory.see(5);
    EXPECT_NEAR(refractory.period_us(), 890, 60);
}

TEST(Refractory, is_a_microsecond_at_least_of_pixels_that_fire_twice_at_once) {
    Refractory refractory;
    for (int i = 0; i < 100'000; ++i) refractory.see(0);
    EXPECT_EQ(refractory.period_us(), 1);
}

}  // namespace
}  // namespace pursuit::tracker
