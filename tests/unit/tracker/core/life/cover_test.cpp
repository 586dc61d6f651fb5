// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/cover.hpp"

#include <gtest/gtest.h>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

void expect_cover_to_tell_all_from_a_part(const Contour& contour) {
    const Outline outline(contour);
    Cover cover(contour);
    const Velocity right{100, 0, 0, 0, 0};
    const auto& pieces = contour.pieces().pieces();
    const auto make_event = [&](std::size_t piece) {
        cover.count(static_cast<std::int32_t>(piece));
        if (cover.is_due()) cover.close_window(outline, {}, right);
    };
    // Each piece makes events by how far it moves across itself.
    const double rounds = 6000 / contour.length_px();
    for (int round = 0; round < 20; ++round) {
        double due = 0;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            due += rounds / 20 * std::abs(pieces[i].by - pieces[i].ay);
            for (; due >= 1; due -= 1) make_event(i);
        }
    }
    EXPECT_GT(cover.share(), 0.8);
    cover.restart();
    for (int round = 0; round < 2000; ++round) make_event(0);
    EXPECT_LT(cover.share(), 0.3);
}

TEST(Cover, is_whole_where_all_of_a_moving_contour_makes_events) {
    expect_cover_to_tell_all_from_a_part(Contour(test::arrow()));
}

TEST(Cover, does_so_for_a_contour_of_more_pieces_than_it_has_parts) {
    expect_cover_to_tell_all_from_a_part(Contour(test::ring("ring", 30, 2000)));
}

TEST(Cover, expects_events_of_the_sides_alone_that_the_growth_moves) {
    const Contour contour(test::polygon("box", {{-20, -20}, {20, -20}, {20, 20}, {-20, 20}}));
    const Outline outline(contour);
    Cover cover(contour);
    const Velocity taller{0, 0, 0, 0, 2};
    const auto& pieces = contour.pieces().pieces();
    for (int round = 0; round < 50; ++round) {
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            if (pieces[i].ay != pieces[i].by) continue;
            cover.count(static_cast<std::int32_t>(i));
            if (cover.is_due()) cover.close_window(outline, {}, taller);
        }
    }
    EXPECT_GT(cover.share(), 0.8);
}

}  // namespace
}  // namespace pursuit::tracker
