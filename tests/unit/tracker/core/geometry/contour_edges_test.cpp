// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/geometry/contour_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "services/tracker/core/geometry/contour.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow;
using test::outline_events;
using test::Poses;
using test::small_sensor;

TEST(WithoutRepeats, is_a_shape_as_it_is_where_no_two_points_lie_on_each_other) {
    const Shape shape = arrow();
    const Shape kept = without_repeats(shape);
    EXPECT_EQ(kept.points_px, shape.points_px);
    EXPECT_EQ(kept.edges, shape.edges);
}

TEST(WithoutRepeats, joins_points_of_one_place_and_leaves_out_edges_between_them_or_twice) {
    Shape shape;
    shape.name = "triangle, twice";
    shape.points_px = {{0, 0}, {20, 0}, {20.001F, 0}, {0, 20}, {0, 0}};
    shape.edges = {{0, 1}, {1, 2}, {2, 3}, {3, 1}, {3, 4}, {4, 0}};
    const Shape kept = without_repeats(shape);
    EXPECT_EQ(kept.points_px, (std::vector<Eigen::Vector2f>{{0, 0}, {20, 0}, {0, 20}}));
    EXPECT_EQ(kept.edges, (std::vector<Edge>{{0, 1}, {1, 2}, {2, 0}}));
    EXPECT_TRUE(Contour(shape).is_outline());
}

TEST(WithoutRepeats, leaves_two_of_four_thousand_points_in_two_places) {
    Shape shape{"two", std::vector<Eigen::Vector2f>(4095, {-1e-3F, 0}), {}};
    shape.points_px.push_back({4, 0});
    EXPECT_EQ(without_repeats(shape).points_px.size(), 2U);
    EXPECT_GT(Contour(shape).length_px(), 3.9);
}

TEST(InferredEdges, are_the_pairs_to_which_no_third_point_is_nearer) {
    std::mt19937 random(4);
    std::vector<Eigen::Vector2f> points;
    for (int i = 0; i < 150; ++i) {
        points.emplace_back(static_cast<float>(random() % 4096) / 64,
                            static_cast<float>(random() % 4096) / 64);
    }
    const auto between2 = [&](std::size_t i, std::size_t j) {
        return (points[i] - points[j]).squaredNorm();
    };
    std::vector<float> nearest2;
    for (std::size_t i = 0; i < points.size(); ++i) {
        float least = 1e9F;
        for (std::size_t j = 0; j < points.size(); ++j) {
            if (j != i) least = std::min(least, between2(i, j));
        }
        nearest2.push_back(least);
    }
    std::sort(nearest2.begin(), nearest2.end());
    std::set<std::pair<std::size_t, std::size_t>> expected;
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t j = i + 1; j < points.size(); ++j) {
            const float own2 = between2(i, j);
            bool is_edge = own2 < 2.5F * 2.5F * nearest2[points.size() / 2];
            for (std::size_t k = 0; k < points.size() && is_edge; ++k) {
                is_edge = k == i || k == j || between2(i, k) >= own2 || between2(j, k) >= own2;
            }
            if (is_edge) expected.emplace(i, j);
        }
    }
    std::set<std::pair<std::size_t, std::size_t>> found;
    for (const Edge& edge : inferred_edges(points)) found.insert(std::minmax(edge.from, edge.to));
    EXPECT_EQ(found, expected);
    EXPECT_GT(found.size(), 100U);
}

TEST(InferredEdges, of_evenly_spaced_points_are_their_outline) {
    const Shape shape = test::arrow();
    std::vector<Edge> edges = inferred_edges(shape.points_px);
    std::size_t right = 0;
    for (const Edge& edge : edges) {
        const auto count = shape.points_px.size();
        right += (edge.from + 1U) % count == edge.to || (edge.to + 1U) % count == edge.from;
    }
    EXPECT_GE(right, shape.points_px.size() - 2);
    EXPECT_LE(edges.size(), shape.points_px.size() + 2);
}

TEST(InferredEdges, of_the_end_of_a_row_reach_the_next_point_alone) {
    EXPECT_TRUE(inferred_edges({}).empty());
    EXPECT_TRUE(inferred_edges({{1, 1}}).empty());
    EXPECT_EQ(inferred_edges({{0, 0}, {2, 0}, {4, 0}}), (std::vector<Edge>{{0, 1}, {1, 2}}));
}

TEST(Tracker, follows_a_shape_whose_points_come_twice_as_the_shape_itself) {
    const Shape once = arrow();
    Shape twice = once;
    twice.edges.clear();
    for (const Eigen::Vector2f& point : once.points_px) twice.points_px.push_back(point);
    const auto truth = [](double t_us) { return pose_of(100 + 1e-4 * t_us, 100, 0.3, 1, 1); };
    const auto events = outline_events(once, truth, 0, 200'000, 60, 5, small_sensor, 3);
    for (const EstimatorKind estimator : {EstimatorKind::gradient, EstimatorKind::kalman}) {
        std::vector<Poses> followed;
        Shape without_edges = once;
        without_edges.edges.clear();
        for (const Shape& shape : {without_edges, twice}) {
            Tracker tracker = Tracker::create({}).value();
            tracker.begin_stream(small_sensor, 1);
            Registration registration;
            registration.shape = shape;
            registration.estimator = estimator;
            registration.start.pose = truth(0);
            ASSERT_TRUE(tracker.register_object(registration));
            tracker.process(events, followed.emplace_back());
        }
        ASSERT_GT(followed[0].rows.size(), 190U);
        for (std::size_t i = 0; i < followed[0].rows.size(); ++i) {
            ASSERT_EQ(followed[0].rows[i].record.pose.t_px, followed[1].rows[i].record.pose.t_px);
        }
        EXPECT_EQ(followed[1].rows.back().record.state, TrackState::tracking);
    }
}

}  // namespace
}  // namespace pursuit::tracker
