// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/spatiotemporal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/edge_events.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

// Two objects whose edges move at 1 px a ms, the second 40 px ahead of the first.
class TwoPlanes : public testing::Test {
 protected:
    explicit TwoPlanes() {
        parameters_.plane_window_s = 0.05;
        parameters_.plane_time_px_s = 1000;
        parameters_.plane_feed = 0;
    }

    void feed(Strategy& strategy, int ms, double second_spread_px = 0) {
        for (const Event& event : test::edge_events(0, ms)) {
            strategy.used(event, {1, 0});
            auto ahead = event;
            ahead.x = static_cast<std::uint16_t>(ahead.x + 40);
            if (event.y % 2 == 0) ahead.x = static_cast<std::uint16_t>(ahead.x + second_spread_px);
            strategy.used(ahead, {2, 0});
        }
    }

    static std::vector<double> given(Strategy& strategy, const Event& event,
                                     std::vector<double> distances_px) {
        std::vector<Claim> claims{{1, distances_px[0]}, {2, distances_px[1]}};
        strategy.assign(event, claims);
        return {claims[0].weight, claims[1].weight};
    }

    StrategyParameters parameters_;
};

using Weights = std::vector<double>;

TEST_F(TwoPlanes, give_the_event_to_whose_plane_it_lies_in_though_the_other_model_is_closer) {
    Spatiotemporal strategy(parameters_);
    feed(strategy, 100);
    // At 100 ms the edges are at 110 and 150 px: (3.14) is 5/√2 and 35/√2.
    EXPECT_EQ(given(strategy, {100'000, 115, 30, 1}, {2.5, 0.5}), (Weights{1, 0}));
    EXPECT_EQ(given(strategy, {100'000, 145, 30, 1}, {0.5, 2.5}), (Weights{0, 1}));
}

TEST_F(TwoPlanes, are_asked_only_after_a_whole_window_and_the_closest_takes_the_event_till_then) {
    Spatiotemporal strategy(parameters_);
    EXPECT_EQ(given(strategy, {0, 115, 30, 1}, {2.5, 0.5}), (Weights{0, 1}));
    feed(strategy, 49);
    EXPECT_EQ(given(strategy, {49'999, 64, 30, 1}, {2.5, 0.5}), (Weights{0, 1}));
    EXPECT_EQ(given(strategy, {50'000, 64, 30, 1}, {2.5, 0.5}), (Weights{1, 0}));
}

TEST_F(TwoPlanes, measure_in_px_or_in_their_own_spread) {
    // The second object is two edges 12 px apart, 6 px from its middle at 156 px. An event at 130
    // lies 20 px from the first plane's place and 26 from the second's.
    parameters_.plane_in_sigma = 0;
    Spatiotemporal in_px(parameters_);
    feed(in_px, 100, 12);
    EXPECT_EQ(given(in_px, {100'000, 130, 30, 1}, {1, 1}), (Weights{1, 0}));
    parameters_.plane_in_sigma = 1;
    Spatiotemporal in_sigma(parameters_);
    feed(in_sigma, 100, 12);
    EXPECT_EQ(given(in_sigma, {100'000, 130, 30, 1}, {1, 1}), (Weights{0, 1}));
}

TEST_F(TwoPlanes, are_fed_by_what_is_taken_or_near_or_near_alone_as_selected) {
    parameters_.plane_in_sigma = 0;
    const auto given_after = [&](double feed, double from_second_px,
                                 std::vector<double> distances_px) {
        parameters_.plane_feed = feed;
        Spatiotemporal strategy(parameters_);
        for (const Event& event : test::edge_events(0, 100)) {
            const std::vector<Claim> first{{1, 2}, {2, from_second_px}};
            strategy.near(event, first);
            auto ahead = event;
            ahead.x = static_cast<std::uint16_t>(ahead.x + 40);
            const std::vector<Claim> second{{2, 1}};
            strategy.near(ahead, second);
        }
        return given(strategy, {100'000, 115, 30, 1}, std::move(distances_px));
    };
    // The first edge's events are 3.5 px from object 2, beyond ambiguity_px: each object has its
    // own edge's plane, unless nothing counts but what is taken.
    EXPECT_EQ(given_after(0, 3.5, {2.5, 0.5}), (Weights{0, 1}));  // the closest's
    EXPECT_EQ(given_after(1, 3.5, {2.5, 0.5}), (Weights{1, 0}));
    EXPECT_EQ(given_after(2, 3.5, {2.5, 0.5}), (Weights{1, 0}));
    // They are ambiguous: object 2 gets both edges, whose least variance is in y, and the event
    // lies 0.5 px from the middle there. Without them object 1 has no plane.
    EXPECT_EQ(given_after(1, 2.5, {0.5, 2.5}), (Weights{0, 1}));
    EXPECT_EQ(given_after(2, 2.5, {0.5, 2.5}), (Weights{1, 0}));  // the closest's
}

TEST_F(TwoPlanes, filter_unambiguous_events_and_background_only_where_selected) {
    parameters_.plane_in_sigma = 0;
    parameters_.plane_reach = 4;
    const Event near{100'000, 115, 30, 1};  // 5/√2 = 3.5 px off the first plane
    const Event far{100'000, 116, 30, 1};   // 6/√2 = 4.2 px
    for (const bool filters : {false, true}) {
        parameters_.plane_filters_unambiguous = filters ? 1 : 0;
        Spatiotemporal strategy(parameters_);
        feed(strategy, 100);
        Claim claim{1, 1};
        claim.weight = 1;
        strategy.confirm(near, claim);
        EXPECT_EQ(claim.weight, 1);
        strategy.confirm(far, claim);
        EXPECT_EQ(claim.weight, filters ? 0 : 1);
        EXPECT_EQ(given(strategy, far, {1, 1}), (Weights{1, 0}));
    }
    parameters_.plane_filters_background = 1;
    Spatiotemporal strategy(parameters_);
    feed(strategy, 100);
    EXPECT_EQ(given(strategy, near, {1, 1}), (Weights{1, 0}));
    EXPECT_EQ(given(strategy, far, {1, 1}), (Weights{0, 0}));
}

TEST_F(TwoPlanes, filter_nothing_before_there_is_a_plane) {
    parameters_.plane_filters_unambiguous = 1;
    parameters_.plane_reach = 0;
    Spatiotemporal strategy(parameters_);
    Claim claim{1, 1};
    claim.weight = 1;
    strategy.confirm({0, 10, 30, 1}, claim);
    EXPECT_EQ(claim.weight, 1);
}

TEST_F(TwoPlanes, are_forgotten_with_their_object_and_with_the_stream) {
    Spatiotemporal strategy(parameters_);
    feed(strategy, 100);
    strategy.forget(2);
    EXPECT_EQ(given(strategy, {100'000, 115, 30, 1}, {2.5, 0.5}), (Weights{0, 1}));
    feed(strategy, 100);
    strategy.restart();
    feed(strategy, 10);  // Event time began anew; no window is whole.
    EXPECT_EQ(given(strategy, {10'000, 24, 30, 1}, {2.5, 0.5}), (Weights{0, 1}));
}

TEST_F(TwoPlanes, are_laid_anew_when_older_than_plane_refit_s) {
    parameters_.plane_refit_s = 0.01;
    Spatiotemporal strategy(parameters_);
    feed(strategy, 100);
    parameters_.plane_filters_unambiguous = 1;
    EXPECT_EQ(given(strategy, {100'000, 115, 30, 1}, {2.5, 0.5}), (Weights{1, 0}));
    // From now on the two have each other's events; the planes follow when laid anew.
    for (const Event& event : test::edge_events(100'001, 60)) {
        auto ahead = event;
        ahead.x = static_cast<std::uint16_t>(ahead.x + 100);
        strategy.used(ahead, {2, 0});
        ahead.x = static_cast<std::uint16_t>(ahead.x + 40);
        strategy.used(ahead, {1, 0});
    }
    EXPECT_EQ(given(strategy, {160'001, 210, 30, 1}, {0.5, 2.5}), (Weights{1, 0}));
}

TEST(SwitchedStrategy, holds_from_its_effective_event_time_on) {
    TrackerOptions options;
    options.emit_updates = true;
    Tracker tracker = std::move(*Tracker::create(options));
    tracker.begin_stream({304, 240}, 1);
    for (const char* name : {"a", "b"}) {
        Registration registration;
        registration.shape = test::arrow(name);
        registration.estimator = EstimatorKind::gradient;
        registration.start.pose = pose_of(100, 100, 0);
        ASSERT_TRUE(tracker.register_object(registration));
    }
    const auto point = test::arrow().points_px[0];
    const auto x = static_cast<std::uint16_t>(std::lround(100 + point.x()));
    const auto y = static_cast<std::uint16_t>(std::lround(100 + point.y()));
    const auto moved_at = [&](std::int64_t t_us) {
        test::Poses poses;
        const std::vector<Event> events{{t_us, x, y, 1}};
        tracker.process(events, poses);
        return poses.updates.size();
    };
    EXPECT_EQ(moved_at(10), 1U);  // closest
    const StrategyKind kinds[] = {StrategyKind::update_all, StrategyKind::spatiotemporal,
                                  StrategyKind::reject_all};
    const std::size_t moves[] = {2, 1, 0};
    std::size_t before = 1;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::int64_t now_us = tracker.last_t_us();
        ASSERT_EQ(tracker.effective_time_us(), now_us + 1);
        ASSERT_TRUE(tracker.set_strategy(kinds[i], {}));
        // One more event of the time that was processed is still the former strategy's.
        EXPECT_EQ(moved_at(now_us), before);
        EXPECT_EQ(moved_at(now_us + 1), moves[i]);
        before = moves[i];
    }
}

TEST(PaperPreset, has_the_paper_s_reading_of_the_planes) {
    const auto preset = find_preset("paper");
    ASSERT_TRUE(preset);
    const StrategyParameters& parameters = (*preset)->strategy_parameters;
    EXPECT_EQ(parameters.plane_window_s, 3);
    EXPECT_EQ(parameters.plane_in_sigma, 0);
    EXPECT_EQ(parameters.plane_feed, 0);
    EXPECT_EQ(parameters.plane_last_per_pixel, 1);
}

}  // namespace
}  // namespace pursuit::tracker
