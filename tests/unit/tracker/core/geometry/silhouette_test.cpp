// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/geometry/silhouette.hpp"

#include <gtest/gtest.h>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

TEST(Silhouette, of_a_box_is_as_deep_as_its_nearest_side) {
    const Silhouette box(
        Contour(test::polygon("box", {{-20, -10}, {20, -10}, {20, 10}, {-20, 10}})));
    EXPECT_FALSE(box.covers_nothing());
    for (double x = -30; x <= 30; x += 1.7) {
        for (double y = -18; y <= 18; y += 1.3) {
            const double dx = std::abs(x) - 20;
            const double dy = std::abs(y) - 10;
            const double outside = std::hypot(std::max(dx, 0.0), std::max(dy, 0.0));
            const double depth = std::max(dx, dy) < 0 ? -std::max(dx, dy) : -outside;
            if (depth > Silhouette::reach_px - 1) continue;
            if (outside > 3) {
                EXPECT_LT(box.depth_px({x, y}), -1.5) << x << " " << y;
                continue;
            }
            EXPECT_NEAR(box.depth_px({x, y}), depth, 1.5) << x << " " << y;
        }
    }
    EXPECT_EQ(box.depth_px({500, 0}), -Silhouette::reach_px);
}

// Cells of 3 px and more, of a side along them, across them and round.
TEST(Silhouette, of_a_large_shape_covers_what_lies_inside_right_to_a_cell) {
    for (const double size_px : {400.0, 700.0, 1500.0, 4000.0}) {
        const double cell_px = std::max(1.0, (1.45 * size_px + 4) / 127);
        Shape box = test::square();
        for (auto& point : box.points_px) {
            point = point.cwiseProduct(Eigen::Vector2f(1, 0.8F)) * static_cast<float>(size_px / 20);
        }
        for (const Shape& shape :
             {box, test::ring("diamond", size_px, 4), test::ring("ring", size_px, 64)}) {
            const Silhouette silhouette{Contour(shape)};
            EXPECT_FALSE(silhouette.covers_nothing()) << shape.name << " " << size_px;
            EXPECT_EQ(silhouette.depth_px({0, 0}), Silhouette::reach_px) << shape.name << size_px;
            // Down the middle, in and out again.
            const double end_px = shape.name == "square" ? 0.8 * size_px : size_px;
            for (double y = -end_px + 1.5 * cell_px; y < end_px - 1.5 * cell_px; y += cell_px) {
                EXPECT_GT(silhouette.depth_px({0.3, y}), 0) << shape.name << size_px << " " << y;
            }
            for (const double sign : {-1, 1}) {
                const double y = sign * (end_px + 1.5 * cell_px);
                EXPECT_LT(silhouette.depth_px({0.3, y}), 0) << shape.name << size_px << " " << y;
                EXPECT_LT(silhouette.depth_px({sign * size_px, y}), 0) << shape.name << size_px;
            }
        }
    }
}

TEST(Silhouette, is_as_deep_in_the_image_as_the_pose_makes_it) {
    const Silhouette box(
        Contour(test::polygon("box", {{-20, -10}, {20, -10}, {20, 10}, {-20, 10}})));
    // On its side, and half as large.
    const Pose pose = pose_of(100, 50, std::numbers::pi / 2, 0.5, 0.5);
    EXPECT_NEAR(box.depth_px({100, 50 + 8}, pose), 2, 0.6);
    EXPECT_NEAR(box.depth_px({100 + 8, 50}, pose), -3, 0.6);
}

TEST(Silhouette, of_a_star_leaves_out_what_lies_between_its_arms) {
    std::vector<Eigen::Vector2d> corners;
    for (int i = 0; i < 10; ++i) {
        const double angle = i * std::numbers::pi / 5;
        corners.push_back((i % 2 == 0 ? 40 : 16) *
                          Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    const Silhouette star(Contour(test::polygon("star", corners)));
    EXPECT_GT(star.depth_px({0, 0}), 8);
    EXPECT_GT(star.depth_px({30, 0}), 1);
    const double between = std::numbers::pi / 5;
    EXPECT_LT(star.depth_px({30 * std::cos(between), 30 * std::sin(between)}), -5);
}

/// A box whose right side is open in the middle.
Shape box_with_gap(double gap_px) {
    const Shape whole = test::polygon("box", {{-20, -20}, {20, -20}, {20, 20}, {-20, 20}});
    const auto is_in_gap = [&](const Eigen::Vector2f& point) {
        return point.x() > 15 && 2 * std::abs(point.y()) < static_cast<float>(gap_px);
    };
    Shape shape;
    shape.name = whole.name;
    std::vector<std::uint16_t> index;
    for (const auto& point : whole.points_px) {
        index.push_back(static_cast<std::uint16_t>(shape.points_px.size()));
        if (!is_in_gap(point)) shape.points_px.push_back(point);
    }
    for (const Edge& edge : whole.edges) {
        if (is_in_gap(whole.points_px[edge.from]) || is_in_gap(whole.points_px[edge.to])) continue;
        shape.edges.push_back({index[edge.from], index[edge.to]});
    }
    return shape;
}

TEST(Silhouette, closes_a_small_gap_and_no_wide_one) {
    Shape an_edge_missing = box_with_gap(0);
    an_edge_missing.edges.pop_back();
    EXPECT_GT(Silhouette(Contour(an_edge_missing)).depth_px({0, 0}), 10);
    EXPECT_LT(Silhouette(Contour(box_with_gap(12))).depth_px({0, 0}), 0);
}

TEST(Silhouette, of_an_open_line_covers_nothing) {
    Shape line;
    line.name = "line";
    for (int i = 0; i < 40; ++i) line.points_px.emplace_back(i, 0);
    for (std::uint16_t i = 0; i + 1 < 40; ++i) {
        line.edges.push_back({i, static_cast<std::uint16_t>(i + 1)});
    }
    const Silhouette silhouette{Contour(centred(line))};
    EXPECT_TRUE(silhouette.covers_nothing());
    EXPECT_LE(silhouette.depth_px({0, 0}), 0);
}

}  // namespace
}  // namespace pursuit::tracker
