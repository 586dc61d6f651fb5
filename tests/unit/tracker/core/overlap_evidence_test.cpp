// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/overlap_evidence.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

OverlapEvidence of(double expected, double observed) {
    OverlapEvidence evidence;
    evidence.add(expected, observed);
    return evidence;
}

TEST(OverlapEvidence, tells_behind_what_makes_few_events_where_the_other_makes_its_own) {
    EXPECT_TRUE(of(40, 4).decide(of(50, 45)));
    EXPECT_FALSE(of(50, 45).decide(of(40, 4)));
    // Neither shows: both stand, or are lost.
    EXPECT_FALSE(of(40, 4).decide(of(50, 5)));
    // Too little to tell.
    EXPECT_FALSE(of(10, 0).decide(of(10, 10)));
}

TEST(OverlapEvidence, tells_behind_what_should_make_few_events_where_the_other_is_plainly_seen) {
    EXPECT_TRUE(of(5, 1).decide(of(200, 190)));
}

TEST(OverlapEvidence, tells_in_front_what_shows_though_it_was_told_to_be_behind) {
    OverlapEvidence evidence = of(40, 4);
    ASSERT_TRUE(evidence.decide(of(50, 45)));
    evidence.add(100, 95);
    EXPECT_FALSE(evidence.decide(of(50, 10)));
}

// The lines of a van pass along those of the car behind it for a tenth of a second.
TEST(OverlapEvidence, leaves_in_front_that_of_which_more_shows) {
    const OverlapEvidence van = of(795, 926);
    OverlapEvidence car = of(44, 5);
    ASSERT_TRUE(car.decide(van));
    car.add(0, 18);
    EXPECT_TRUE(car.decide(van));
}

TEST(OverlapEvidence, fades_and_holds_what_was_found) {
    OverlapEvidence evidence = of(40, 4);
    EXPECT_FALSE(evidence.is_faded());
    ASSERT_TRUE(evidence.decide(of(50, 45)));
    evidence.fade(0.01);
    EXPECT_TRUE(evidence.is_faded());
    EXPECT_TRUE(evidence.decide(of(0.5, 0.4)));
}

}  // namespace
}  // namespace pursuit::tracker
