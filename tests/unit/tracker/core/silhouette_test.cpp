// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/silhouette.hpp"

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
            if (std::abs(depth) > Silhouette::reach_px - 1) continue;
            EXPECT_NEAR(box.depth_px({x, y}), depth, 1.5) << x << " " << y;
        }
    }
    EXPECT_EQ(box.depth_px({500, 0}), -Silhouette::reach_px);
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

TEST(Silhouette, closes_a_gap_of_three_pixels_and_no_wider_one) {
    for (const double gap_px : {0.0, 2.5, 12.0}) {
        Shape shape = test::polygon("box", {{-20, -20}, {20, -20}, {20, 20}, {-20, 20}});
        std::erase_if(shape.edges, [&](const Edge& edge) {
            const auto& from = shape.points_px[edge.from];
            const auto& to = shape.points_px[edge.to];
            const float half = static_cast<float>(gap_px / 2);
            return from.x() > 15 && to.x() > 15 && std::abs((from.y() + to.y()) / 2) < half;
        });
        const Silhouette box{Contour(shape)};
        EXPECT_EQ(box.depth_px({0, 0}) > 0, gap_px < 10) << gap_px;
    }
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
