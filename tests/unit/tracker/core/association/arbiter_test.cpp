// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/arbiter.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

/// Two objects or three at these distances from one event, and what each is given of it.
std::vector<double> given(Arbiter& arbiter, const std::vector<double>& distances_px) {
    const Event event{1000, 10, 10, 1};
    arbiter.begin();
    for (std::size_t i = 0; i < distances_px.size(); ++i) {
        arbiter.claim(i, static_cast<std::uint32_t>(i + 1), distances_px[i], 0, false);
    }
    arbiter.give(event, [](std::size_t) { return 0.5; });
    std::vector<double> weights;
    for (std::size_t i = 0; i < arbiter.count(); ++i) weights.push_back(arbiter.weight(i));
    return weights;
}

Arbiter of(StrategyKind kind) { return Arbiter(8, kind, StrategyParameters()); }

TEST(Arbiter, has_nothing_to_say_of_one_claim_unless_the_strategy_listens) {
    Arbiter by_distance = of(StrategyKind::weighted);
    EXPECT_FALSE(by_distance.is_plain());
    by_distance.claim(0, 1, 2, 0, false);
    EXPECT_TRUE(by_distance.is_plain());
    Arbiter by_planes = of(StrategyKind::spatiotemporal);
    by_planes.claim(0, 1, 2, 0, false);
    EXPECT_FALSE(by_planes.is_plain());
    EXPECT_EQ(given(by_planes, {2}), std::vector<double>({1}));
}

TEST(Arbiter, gives_what_is_near_one_alone_to_the_closest_whatever_the_strategy) {
    Arbiter arbiter = of(StrategyKind::weighted);
    EXPECT_EQ(given(arbiter, {5, 1}), std::vector<double>({0, 1}));
    EXPECT_EQ(given(arbiter, {5, 4}), std::vector<double>({0, 1}));
}

TEST(Arbiter, lets_the_strategy_give_what_is_near_all) {
    Arbiter arbiter = of(StrategyKind::weighted);
    const auto weights = given(arbiter, {1, 3});
    EXPECT_DOUBLE_EQ(weights[0], 0.75);
    EXPECT_DOUBLE_EQ(weights[1], 0.25);
    arbiter.set_strategy(StrategyKind::reject_all, StrategyParameters());
    EXPECT_EQ(given(arbiter, {1, 3}), std::vector<double>({0, 0}));
}

TEST(Arbiter, leaves_out_who_is_not_near_where_two_others_are) {
    Arbiter arbiter = of(StrategyKind::weighted);
    const auto weights = given(arbiter, {1, 5, 3});
    EXPECT_DOUBLE_EQ(weights[0], 0.75);
    EXPECT_EQ(weights[1], 0);
    EXPECT_DOUBLE_EQ(weights[2], 0.25);
}

TEST(Arbiter, begins_each_event_without_claims) {
    Arbiter arbiter = of(StrategyKind::closest);
    EXPECT_EQ(given(arbiter, {1, 2, 3}).size(), 3U);
    arbiter.begin();
    EXPECT_EQ(arbiter.count(), 0U);
}

}  // namespace
}  // namespace pursuit::tracker
