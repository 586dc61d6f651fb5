// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "services/tracker/core/association/strategy.hpp"
#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

constexpr Event any_event{1000, 5, 5, 1};

std::vector<Claim> at_distances(const std::vector<double>& distances_px) {
    std::vector<Claim> claims;
    std::uint32_t object_id = 0;
    for (const double distance_px : distances_px) claims.push_back({++object_id, distance_px});
    return claims;
}

std::vector<double> given(StrategyKind kind, std::vector<Claim> claims) {
    make_strategy(kind, {})->assign(any_event, claims);
    std::vector<double> weights;
    for (const Claim& claim : claims) weights.push_back(claim.weight);
    return weights;
}

using Weights = std::vector<double>;

TEST(Closest, gives_the_event_to_the_nearest_and_of_equals_to_the_first) {
    EXPECT_EQ(given(StrategyKind::closest, at_distances({2, 1, 1.5})), (Weights{0, 1, 0}));
    EXPECT_EQ(given(StrategyKind::closest, at_distances({1, 1})), (Weights{1, 0}));
}

TEST(RejectAll, gives_the_event_to_nobody) {
    EXPECT_EQ(given(StrategyKind::reject_all, at_distances({2, 1})), (Weights{0, 0}));
}

TEST(UpdateAll, gives_the_whole_event_to_everybody) {
    EXPECT_EQ(given(StrategyKind::update_all, at_distances({2, 1})), (Weights{1, 1}));
}

TEST(Weighted, shares_by_the_inverse_distance) {
    EXPECT_EQ(given(StrategyKind::weighted, at_distances({1, 3})), (Weights{0.75, 0.25}));
    const Weights three = given(StrategyKind::weighted, at_distances({1, 2, 2}));
    EXPECT_DOUBLE_EQ(three[0], 0.5);
    EXPECT_DOUBLE_EQ(three[1], 0.25);
}

TEST(Weighted, gives_everything_to_whom_the_event_lies_on) {
    EXPECT_EQ(given(StrategyKind::weighted, at_distances({0, 3})), (Weights{1, 0}));
    EXPECT_EQ(given(StrategyKind::weighted, at_distances({0, 3, 0})), (Weights{0.5, 0, 0.5}));
}

TEST(Probabilistic, shares_by_likelihood_beside_clutter) {
    std::vector<Claim> claims = at_distances({1, 1});
    claims[0].likelihood = 0.6;
    claims[1].likelihood = 0.2;
    claims[0].clutter = claims[1].clutter = 0.2;
    claims[0].is_weighed = claims[1].is_weighed = true;
    make_strategy(StrategyKind::probabilistic, {})->assign(any_event, claims);
    // β_1 = 0.6/(0.2 + 0.8); the estimator itself has the factor 0.6/(0.2 + 0.6).
    EXPECT_DOUBLE_EQ(claims[0].weight * 0.6 / 0.8, 0.6);
    EXPECT_DOUBLE_EQ(claims[1].weight * 0.2 / 0.4, 0.2);
}

TEST(Probabilistic, gives_all_of_its_share_to_what_does_not_weigh_clutter_by_itself) {
    std::vector<Claim> claims = at_distances({1, 1});
    claims[0].likelihood = 0.6;
    claims[1].likelihood = 0.2;
    claims[0].clutter = claims[1].clutter = 0.2;
    claims[1].is_weighed = true;
    make_strategy(StrategyKind::probabilistic, {})->assign(any_event, claims);
    EXPECT_DOUBLE_EQ(claims[0].weight, 0.6);
    EXPECT_DOUBLE_EQ(claims[1].weight * 0.2 / 0.4, 0.2);
}

TEST(Probabilistic, gives_nothing_where_nothing_is_likely) {
    EXPECT_EQ(given(StrategyKind::probabilistic, at_distances({1, 1})), (Weights{0, 0}));
}

TEST(Temporal, gives_the_event_to_the_object_whose_next_is_due) {
    StrategyParameters parameters;
    parameters.temporal_events = 3;
    const auto strategy = make_strategy(StrategyKind::temporal, parameters);
    // Object 1 every 100 µs, last at 900: due at 1000, C = 1. Object 2 every 400 µs, last at 900:
    // C = 0.25.
    for (const std::int64_t t_us : {600, 700, 800, 900}) {
        strategy->used({t_us, 5, 5, 1}, {1, 0});
    }
    for (const std::int64_t t_us : {100, 500, 900}) strategy->used({t_us, 5, 5, 1}, {2, 0});
    std::vector<Claim> claims = at_distances({2, 1});
    strategy->assign(any_event, claims);
    EXPECT_EQ(claims[0].weight, 1);
    EXPECT_EQ(claims[1].weight, 0);
    strategy->assign({1300, 5, 5, 1}, claims);
    EXPECT_EQ(claims[0].weight, 0);
    EXPECT_EQ(claims[1].weight, 1);
}

TEST(Temporal, gives_the_event_to_the_closest_until_it_knows_the_rates) {
    const auto strategy = make_strategy(StrategyKind::temporal, {});
    std::vector<Claim> claims = at_distances({2, 1});
    strategy->assign(any_event, claims);
    EXPECT_EQ(claims[1].weight, 1);
}

// Two arrows that share a place: an event there is ambiguous, one at a tip that the other does not
// have is not.
class TwoArrows : public testing::TestWithParam<StrategyKind> {};

TEST_P(TwoArrows, are_moved_by_an_ambiguous_event_as_the_strategy_says) {
    TrackerOptions options;
    options.emit_updates = true;
    Tracker tracker = std::move(*Tracker::create(options));
    tracker.begin_stream({304, 240}, 1);
    const std::vector<NamedValue> parameters{{"ambiguity_px", 2}};
    ASSERT_TRUE(tracker.set_strategy(GetParam(), parameters));
    EXPECT_EQ(tracker.settings().strategy, GetParam());
    EXPECT_EQ(tracker.settings().strategy_parameters.ambiguity_px, 2);
    for (const auto& [name, x_px] : {std::pair{"a", 100.0}, std::pair{"b", 101.0}}) {
        Registration registration;
        registration.shape = test::arrow(name);
        registration.estimator = EstimatorKind::gradient;
        registration.start.pose = pose_of(x_px, 100, 0);
        ASSERT_TRUE(tracker.register_object(registration));
    }
    const Shape shape = test::arrow();
    float right_px = 0;
    float its_y_px = 0;
    for (const auto& point : shape.points_px) {
        if (point.x() > right_px) {
            right_px = point.x();
            its_y_px = point.y();
        }
    }
    const auto y = static_cast<std::uint16_t>(std::lround(100 + its_y_px));
    const auto tip_x = static_cast<std::uint16_t>(std::lround(100 + right_px));
    test::Poses poses;
    const std::vector<Event> shared{{10, tip_x, y, 1}};
    tracker.process(shared, poses);
    const std::size_t moved = poses.updates.size();
    switch (GetParam()) {
        case StrategyKind::reject_all:
            EXPECT_EQ(moved, 0U);
            break;
        case StrategyKind::closest:
        case StrategyKind::temporal:
        case StrategyKind::spatiotemporal:
            EXPECT_EQ(moved, 1U);
            break;
        default:
            EXPECT_EQ(moved, 2U);
    }
    // 3.6 px beyond the tip of a, 2.6 beyond b's: near neither by 2 px, so the closest object's.
    const std::vector<Event> beyond{{20, static_cast<std::uint16_t>(tip_x + 4), y, 1}};
    poses.updates.clear();
    tracker.process(beyond, poses);
    ASSERT_EQ(poses.updates.size(), 1U);
    EXPECT_EQ(poses.updates[0].object_id, 2U);
}

INSTANTIATE_TEST_SUITE_P(EveryStrategy, TwoArrows,
                         testing::Values(StrategyKind::closest, StrategyKind::reject_all,
                                         StrategyKind::update_all, StrategyKind::weighted,
                                         StrategyKind::temporal, StrategyKind::spatiotemporal,
                                         StrategyKind::probabilistic),
                         [](const auto& made) { return std::string(to_string(made.param)); });

}  // namespace
}  // namespace pursuit::tracker
