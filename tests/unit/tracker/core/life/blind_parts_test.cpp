// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/blind_parts.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/geometry/contour.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

constexpr Geometry geometry{200, 100};
constexpr double right_px_s = 5000;

/// A box, 20 px across, that goes right for a while before a sensor whose pixels are blind for
/// 5 ms: only its near side makes events. Then how much of its length can be seen.
double seen_length_share(double speed_px_s) {
    const Contour contour(test::polygon("box", {{-10, -10}, {10, -10}, {10, 10}, {-10, 10}}));
    Outline outline(contour);
    RecentPixels pixels;
    pixels.restart(geometry);
    // Elsewhere something flickers as fast as pixels can.
    std::int64_t began_us = 0;
    for (int i = 0; i < 20'000; ++i) pixels.note({began_us += 5'000, 199, 99, 1});
    auto t_us = static_cast<double>(began_us);
    Pose pose;
    for (double x_px = 30; x_px < 80; x_px += 1) {
        t_us += 1e6 / speed_px_s;
        pose.t_px << x_px, 50;
        for (int y = 40; y <= 60; ++y) {
            pixels.note({static_cast<std::int64_t>(t_us), static_cast<std::uint16_t>(x_px + 10),
                         static_cast<std::uint16_t>(y), 0});
        }
        look_for_blind_parts(static_cast<std::int64_t>(t_us), pose, {speed_px_s, 0, 0, 0, 0}, 15,
                             pixels, outline);
    }
    double seen_px = 0;
    const auto& pieces = contour.pieces().pieces();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (!outline.can_be_seen(static_cast<std::int32_t>(i))) continue;
        seen_px += std::hypot(pieces[i].bx - pieces[i].ax, pieces[i].by - pieces[i].ay);
    }
    return seen_px / contour.length_px();
}

TEST(BlindParts, are_those_that_come_over_pixels_where_another_part_just_was) {
    EXPECT_LT(seen_length_share(right_px_s), 0.8);
    EXPECT_GT(seen_length_share(right_px_s), 0.2);
}

TEST(BlindParts, are_those_that_grow_over_pixels_that_just_fired) {
    const Contour contour(test::polygon("box", {{-10, -10}, {10, -10}, {10, 10}, {-10, 10}}));
    Outline outline(contour);
    RecentPixels pixels;
    pixels.restart(geometry);
    std::int64_t t_us = 0;
    for (int i = 0; i < 20'000; ++i) pixels.note({t_us += 5'000, 199, 99, 1});
    // All that the box would come over, whichever way it grew.
    for (std::uint16_t y = 30; y < 70; ++y) {
        for (std::uint16_t x = 30; x < 70; ++x) pixels.note({t_us, x, y, 0});
    }
    const Velocity taller{0, 0, 0, 0, right_px_s / 10};
    for (int i = 0; i < 10; ++i) {
        look_for_blind_parts(t_us, pose_of(50, 50, 0), taller, 15, pixels, outline);
    }
    const auto& pieces = contour.pieces().pieces();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const bool is_upright = pieces[i].ax == pieces[i].bx;
        // (Its corners go up and down as fast as its top does.)
        if (is_upright && std::abs(pieces[i].ay + pieces[i].by) > 4) continue;
        EXPECT_EQ(outline.can_be_seen(static_cast<std::int32_t>(i)), is_upright) << i;
    }
}

TEST(BlindParts, are_forgotten_while_an_object_stands) {
    const Contour contour(test::polygon("box", {{-10, -10}, {10, -10}, {10, 10}, {-10, 10}}));
    Outline outline(contour);
    for (Outline::Part& part : outline.parts()) outline.set_blind(part, 1);
    RecentPixels pixels;
    pixels.restart(geometry);
    for (int i = 0; i < 10; ++i) look_for_blind_parts(0, Pose(), Velocity(), 15, pixels, outline);
    for (std::int32_t piece = 0; piece < 4; ++piece) EXPECT_TRUE(outline.can_be_seen(piece));
}

TEST(BlindParts, are_none_of_an_object_that_takes_longer_than_its_pixels_are_blind) {
    EXPECT_EQ(seen_length_share(right_px_s / 10), 1);
}

}  // namespace
}  // namespace pursuit::tracker
