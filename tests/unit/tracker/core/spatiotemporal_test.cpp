// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/spatiotemporal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

// An upright edge that moves right by 1 px a ms, from x = 10 at `from_us` on: with c = 1000 px/s
// its events lie in the plane x − 10 = c·(t − from), normal (1, 0, −1)/√2.
std::vector<Event> edge_events(std::int64_t from_us, int ms) {
    std::vector<Event> events;
    for (int k = 0; k <= ms; ++k) {
        for (int y = 20; y < 40; ++y) {
            events.push_back({from_us + k * 1000, static_cast<std::uint16_t>(10 + k),
                              static_cast<std::uint16_t>(y), 1});
        }
    }
    return events;
}
constexpr double c_px_us = 1e-3;

TEST(Plane, of_an_edge_that_moves_evenly_is_as_computed_by_hand) {
    PlaneSums sums;
    for (const Event& event : edge_events(5000, 100)) sums.add(event.x, event.y, event.t_us);
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
    for (const Event& event : edge_events(0, 100)) {
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

// What a window should hold: the events one by one.
struct Recount {
    Recount(std::int64_t window, std::size_t most, bool last_only)
        : window_us(window), limit(most), is_last_per_pixel(last_only) {}

    PlaneSums add(const Event& event) {
        events.push_back(event);
        if (events.size() > limit) events.erase(events.begin());
        std::erase_if(events, [&](const Event& e) { return e.t_us < event.t_us - window_us; });
        PlaneSums sums;
        std::map<std::pair<int, int>, Event> last;
        for (const Event& e : events) last[{e.x, e.y}] = e;
        for (const Event& e : events) {
            if (is_last_per_pixel && !(last[{e.x, e.y}] == e)) continue;
            sums.add(e.x, e.y, e.t_us);
        }
        return sums;
    }

    std::int64_t window_us;
    std::size_t limit;
    bool is_last_per_pixel;
    std::vector<Event> events;
};

class Window : public testing::TestWithParam<bool> {};

TEST_P(Window, holds_what_a_recount_of_its_events_gives) {
    // Limits that bind and that do not; storage that grows while pixels fire again and again.
    for (const auto& [window_us, limit] :
         {std::pair<std::int64_t, std::size_t>{700, 50}, {300, 5000}, {100'000, 1500}}) {
        EventWindow window(window_us, limit, GetParam());
        Recount recount(window_us, limit, GetParam());
        std::mt19937 random(7);
        std::int64_t t_us = 0;
        for (int i = 0; i < 3000; ++i) {
            t_us += 1 + random() % 3 + (random() % 500 == 0 ? 800 : 0);
            const Event event{t_us, static_cast<std::uint16_t>(random() % 16),
                              static_cast<std::uint16_t>(random() % 8), 1};
            window.add(event);
            const PlaneSums expected = recount.add(event);
            ASSERT_EQ(window.sums().count(), expected.count()) << i;
            if (i % 10 != 0 || expected.count() < 3) continue;
            const auto plane = window.sums().fit(1e-2, t_us);
            const auto expected_plane = expected.fit(1e-2, t_us);
            ASSERT_EQ(plane->normal, expected_plane->normal) << i;
            ASSERT_EQ(plane->centre_px, expected_plane->centre_px) << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(EveryEventOrTheLastOfAPixel, Window, testing::Bool(),
                         [](const auto& made) { return made.param ? "last" : "every"; });

TEST(Window, is_whole_once_fed_for_its_length_and_begins_anew_when_it_ran_empty) {
    EventWindow window(1000, 100, false);
    EXPECT_FALSE(window.is_whole(0));
    for (std::int64_t t_us = 500; t_us <= 1499; ++t_us) window.add({t_us, 1, 1, 1});
    EXPECT_FALSE(window.is_whole(1499));
    EXPECT_TRUE(window.is_whole(1500));
    window.reach(2500);
    EXPECT_EQ(window.sums().count(), 0U);
    EXPECT_FALSE(window.is_whole(2500));
    window.add({2600, 1, 1, 1});
    EXPECT_FALSE(window.is_whole(3599));
    EXPECT_TRUE(window.is_whole(3600));
}

// Two objects whose edges move at 1 px a ms, the second 40 px ahead of the first.
class TwoPlanes : public testing::Test {
 protected:
    explicit TwoPlanes() {
        parameters_.plane_window_s = 0.05;
        parameters_.plane_time_px_s = 1000;
        parameters_.plane_feed = 0;
    }

    void feed(Strategy& strategy, int ms, double second_spread_px = 0) {
        for (const Event& event : edge_events(0, ms)) {
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
        for (const Event& event : edge_events(0, 100)) {
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
    for (const Event& event : edge_events(100'001, 60)) {
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
