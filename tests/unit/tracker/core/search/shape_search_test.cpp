// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/search/shape_search.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/life/where_to_look.hpp"
#include "services/tracker/core/search/drawn_contour.hpp"
#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::anywhere;
using test::small_sensor;

/// The outline's pixels under a pose, and `noise` pixels anywhere.
std::vector<Event> fired(const Shape& shape, const Pose& pose, int noise, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<Event> events;
    const auto put = [&](double x, double y) {
        if (x < 0 || y < 0 || x > small_sensor.width - 1 || y > small_sensor.height - 1) return;
        events.push_back({0, static_cast<std::uint16_t>(std::lround(x)),
                          static_cast<std::uint16_t>(std::lround(y)), 1});
    };
    for (const Edge& edge : shape.edges) {
        const Eigen::Vector2d middle =
            (shape.points_px[edge.from] + shape.points_px[edge.to]).cast<double>() / 2;
        const Eigen::Vector2d p = pose.t_px + pose.a * middle;
        put(p.x(), p.y());
    }
    for (int i = 0; i < noise; ++i) {
        put(static_cast<double>(random() % small_sensor.width),
            static_cast<double>(random() % small_sensor.height));
    }
    return events;
}

std::optional<ShapeSearch::Found> search(const Shape& shape, const std::vector<Event>& events,
                                         const SearchRange& range, int slice = 1 << 30) {
    FiredMap map;
    map.build(small_sensor, events);
    ShapeSearch search{Contour(shape)};
    search.begin(map, range);
    while (!search.is_done()) search.step(slice);
    return search.found();
}

TEST(FiredMap, has_the_chamfer_distance_to_the_nearest_pixel_that_fired) {
    std::mt19937 random(3);
    std::vector<Event> events;
    for (int i = 0; i < 60; ++i) {
        events.push_back({i, static_cast<std::uint16_t>(random() % 304),
                          static_cast<std::uint16_t>(random() % 240), 1});
    }
    FiredMap map;
    map.build(small_sensor, events);
    for (int y = 0; y < 240; y += 7) {
        for (int x = 0; x < 304; x += 5) {
            int best = FiredMap::farthest;
            for (const Event& event : events) {
                const int dx = std::abs(event.x - x);
                const int dy = std::abs(event.y - y);
                best = std::min(best, 3 * std::max(dx, dy) + std::min(dx, dy));
            }
            ASSERT_EQ(map.distance(x, y), best) << x << " " << y;
        }
    }
    EXPECT_EQ(map.distance(-1, 0), FiredMap::farthest);
    EXPECT_EQ(map.around(152, 120, 1000).fired, 60);
}

TEST(FiredMap, tells_what_is_around_a_cell_where_nothing_fired_as_well) {
    std::vector<Event> events;
    for (std::uint16_t i = 0; i < 30; ++i) {
        events.push_back(
            {i, static_cast<std::uint16_t>(100 + i), static_cast<std::uint16_t>(2 * i), 1});
    }
    FiredMap map;
    map.build(small_sensor, events);
    for (int y = 0; y < 240; y += 19) {
        for (int x = 0; x < 304; x += 17) {
            double count = 0;
            double fired = 0;
            double sum = 0;
            double squared = 0;
            for (int row = std::max(y - 9, 0); row <= std::min(y + 9, 239); ++row) {
                for (int column = std::max(x - 9, 0); column <= std::min(x + 9, 303); ++column) {
                    const double d = map.distance(column, row);
                    ++count;
                    fired += d > 0 ? 0 : 1;
                    sum += d;
                    squared += d * d;
                }
            }
            const FiredMap::Around around = map.around(x, y, 9);
            ASSERT_EQ(around.fired, fired) << x << " " << y;
            ASSERT_DOUBLE_EQ(around.mean, sum / count) << x << " " << y;
            ASSERT_NEAR(around.variance, squared / count - sum / count * (sum / count), 1e-9);
        }
    }
}

TEST(FiredMap, of_a_large_image_has_cells_of_several_pixels) {
    FiredMap map;
    map.build({1280, 720}, std::vector<Event>{{0, 1279, 719, 1}});
    EXPECT_LE(map.columns() * map.rows(), 100'000);
    EXPECT_EQ(map.distance(map.columns() - 1, map.rows() - 1), 0);
}

TEST(FiredMap, has_no_more_cells_near_a_place_than_the_image_has) {
    FiredMap map;
    map.build(small_sensor, std::vector<Event>{{0, 10, 10, 1}});
    const auto expect_cells = [&](double x_px, double y_px, double reach_px, int left, int top,
                                  int right, int bottom) {
        const FiredMap::Cells near = map.cells_near(x_px, y_px, reach_px);
        EXPECT_EQ(near.left, left) << x_px << " " << reach_px;
        EXPECT_EQ(near.top, top) << x_px << " " << reach_px;
        EXPECT_EQ(near.right, right) << x_px << " " << reach_px;
        EXPECT_EQ(near.bottom, bottom) << x_px << " " << reach_px;
    };
    expect_cells(100, 90.5, 10, 90, 80, 111, 101);
    expect_cells(2, 238, 10, 0, 228, 13, 240);
    // As large as a shape's extent and scale can be.
    expect_cells(152, 120, 580'000, 0, 0, 304, 240);
    expect_cells(-99'000, 120, 100'000, 0, 0, 304, 240);
    for (const double beyond_px : {-500.0, 800.0, 1e300}) {
        const FiredMap::Cells near = map.cells_near(beyond_px, 120, 10);
        EXPECT_GE(near.left, near.right) << beyond_px;
    }
}

TEST(DrawnContour, is_drawn_in_every_cell_that_it_crosses_once) {
    const Shape arrow = test::arrow();
    const std::vector<Piece> pieces = Contour(arrow).pieces().pieces();
    const auto drawn = drawn_contour(pieces, {-100, -100}, {201, 201});
    FiredMap map;
    map.build({201, 201}, drawn);
    EXPECT_EQ(drawn.size(), static_cast<std::size_t>(map.around(100, 100, 200).fired));
    for (const Piece& piece : pieces) {
        for (double at = 0; at <= 1; at += 0.1) {
            const double x = piece.ax + at * (piece.bx - piece.ax) + 100;
            const double y = piece.ay + at * (piece.by - piece.ay) + 100;
            EXPECT_LE(
                map.distance(static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y))),
                3);
        }
    }
}

TEST(DrawnContour, takes_no_more_steps_and_events_of_a_very_long_one_than_its_cells_need) {
    std::mt19937 random(1);
    std::vector<Piece> pieces;
    double length_px = 0;
    const auto anywhere_px = [&] { return static_cast<double>(random() % 8000) - 4000; };
    for (int i = 0; i < 4096; ++i) {
        pieces.push_back({anywhere_px(), anywhere_px(), anywhere_px(), anywhere_px()});
        length_px += std::hypot(pieces[i].bx - pieces[i].ax, pieces[i].by - pieces[i].ay);
    }
    constexpr Geometry geometry{8001, 8001};
    const auto drawn = drawn_contour(pieces, {-4000, -4000}, geometry);
    EXPECT_LE(drawn.size(), 100'000U);
    const int cell_px = FiredMap::cell_px_of(geometry);
    EXPECT_LT(length_px / drawing_step_px(length_px, cell_px), 2e6);
    // As finely as ever where that is no trouble.
    EXPECT_EQ(drawing_step_px(20'000, cell_px), 0.5);
    // And without gaps.
    const auto some = std::span(pieces).first(40);
    FiredMap map;
    map.build(geometry, drawn_contour(some, {-4000, -4000}, geometry));
    EXPECT_LT(map.around(map.columns() / 2, map.rows() / 2, map.columns()).fired, 30'000);
    for (const Piece& piece : some) {
        for (double at = 0; at <= 1; at += 0.001) {
            const double x = piece.ax + at * (piece.bx - piece.ax) + 4000;
            const double y = piece.ay + at * (piece.by - piece.ay) + 4000;
            EXPECT_LE(map.distance(static_cast<int>(x / cell_px), static_cast<int>(y / cell_px)),
                      3);
        }
    }
}

TEST(ShapeSearch, finds_a_shape_at_any_place_angle_and_size) {
    const Shape arrow = test::arrow();
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        const Pose truth = pose_of(60 + 15 * seed, 180 - 10 * seed, 0.5 * seed, 0.75 + 0.045 * seed,
                                   0.75 + 0.045 * seed);
        const auto found = search(arrow, fired(arrow, truth, 100, seed), anywhere());
        ASSERT_TRUE(found) << seed;
        EXPECT_LT(test::rms_px(arrow, found->pose, truth), 3) << seed;
    }
}

TEST(ShapeSearch, takes_no_noise_and_no_other_shape_for_it) {
    const Shape arrow = test::arrow();
    const Shape box = test::polygon("box", {{-40, -30}, {40, -30}, {40, 30}, {-40, 30}});
    EXPECT_FALSE(search(arrow, {}, anywhere()));
    EXPECT_FALSE(search(arrow, fired(arrow, pose_of(-500, 0, 0), 6000, 1), anywhere()));
    EXPECT_FALSE(search(arrow, fired(box, pose_of(150, 120, 0.3), 100, 2), anywhere()));
}

TEST(ShapeSearch, is_not_drawn_to_the_many_lines_of_something_else) {
    const Shape arrow = test::arrow();
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
        const Pose truth = pose_of(60 + 5 * seed, 60 + 5 * seed, 0.7 * seed);
        auto events = fired(arrow, truth, 300, seed);
        // A grating beside it: any contour lies on much of it.
        for (std::uint16_t x = 160; x < 290; x = static_cast<std::uint16_t>(x + 5)) {
            for (std::uint16_t y = 120; y < 230; ++y) events.push_back({0, x, y, 1});
        }
        const auto found = search(arrow, events, anywhere());
        ASSERT_TRUE(found) << seed;
        EXPECT_LT(test::rms_px(arrow, found->pose, truth), 3) << seed;
    }
}

TEST(ShapeSearch, finds_the_same_in_slices_as_at_once) {
    const Shape arrow = test::arrow();
    const auto events = fired(arrow, pose_of(100, 90, 1), 500, 5);
    const auto at_once = search(arrow, events, anywhere());
    const auto in_slices = search(arrow, events, anywhere(), 7);
    ASSERT_TRUE(at_once && in_slices);
    EXPECT_EQ(at_once->pose, in_slices->pose);
}

TEST(ShapeSearch, of_two_the_same_takes_the_nearer) {
    const Shape arrow = test::arrow();
    auto events = fired(arrow, pose_of(100, 90, 0), 0, 6);
    const auto other = fired(arrow, pose_of(160, 150, 0), 0, 7);
    events.insert(events.end(), other.begin(), other.end());
    SearchRange near = anywhere();
    near.around = pose_of(150, 140, 0);
    near.reach_px = 80;
    near.angle_rad = 0.5;
    near.log_scale = 0;
    near.usual_distance_px = 20;
    const auto found = search(arrow, events, near);
    ASSERT_TRUE(found);
    EXPECT_LT((found->pose.t_px - Eigen::Vector2d(160, 150)).norm(), 3);
}

TEST(Search, finds_a_registered_shape_that_enters_and_then_follows_it) {
    const Shape arrow = test::arrow();
    const auto truth = [](double t_us) {
        return pose_of(20 + 150e-6 * t_us, 100 + 20e-6 * t_us, 0.8, 1, 1);
    };
    Tracker tracker = std::move(*Tracker::create({}));
    tracker.begin_stream(small_sensor, 1);
    Registration registration;
    registration.shape = arrow;
    registration.transform = TransformKind::similarity;
    registration.estimator = EstimatorKind::kalman;
    registration.start.search = true;
    ASSERT_TRUE(tracker.register_object(registration));
    test::Poses poses;
    // Half in view at the start.
    tracker.process(test::outline_events(arrow, truth, 0, 800'000, 60, 5, small_sensor, 1), poses);
    std::int64_t found_us = -1;
    for (const auto& row : poses.rows) {
        const double off_px =
            test::rms_px(arrow, row.record.pose, truth(static_cast<double>(row.record.t_us)));
        if (row.record.state != TrackState::tracking) {
            EXPECT_EQ(row.record.confidence, 0) << row.record.t_us;
            continue;
        }
        if (found_us < 0) found_us = row.record.t_us;
        EXPECT_FALSE(row.record.confidence > 0.5F && off_px > 10) << row.record.t_us;
    }
    // Wholly in view from 0.1 s on.
    EXPECT_GT(found_us, 0);
    EXPECT_LT(found_us, 300'000);
    EXPECT_LT(test::rms_px(arrow, poses.rows.back().record.pose, truth(8e5)), 1);
}

TEST(ShapeSearch, of_a_check_finds_a_shape_from_one_stretched_over_some_of_its_edges) {
    // An H, of which a larger or smaller one lies on the upper rim and some other edges as well.
    const Shape h = test::polygon("H", {{-25, -30},
                                        {-11, -30},
                                        {-11, -7},
                                        {11, -7},
                                        {11, -30},
                                        {25, -30},
                                        {25, 30},
                                        {11, 30},
                                        {11, 7},
                                        {-11, 7},
                                        {-11, 30},
                                        {-25, 30}});
    const Contour contour(h);
    for (const double by : {0.7, 0.8, 0.9, 1.12, 1.25, 1.4}) {
        const Pose truth = pose_of(150, 120, 0.3, 1.1, 0.9);
        Pose own = truth;
        own.a.col(1) *= by;
        own.t_px += (truth.a.col(1) - own.a.col(1)) * -30;
        SearchRange range;
        range.around = own;
        range.reach_px = 30;
        range.angle_rad = 0.5;
        range.usual_distance_px = 15;
        range.is_check = true;
        range.seeds = {own};
        range.stretched = stretched_poses(contour, own);
        FiredMap map;
        map.build(small_sensor, fired(h, truth, 30, 1));
        ShapeSearch search{contour};
        search.begin(map, range);
        while (!search.is_done()) search.step(1000);
        ASSERT_TRUE(search.found()) << by;
        EXPECT_LT(test::rms_px(h, search.found()->pose, truth), 2) << by;
        EXPECT_GT(search.explained(search.found()->pose), search.explained(own)) << by;
    }
}

}  // namespace
}  // namespace pursuit::tracker
