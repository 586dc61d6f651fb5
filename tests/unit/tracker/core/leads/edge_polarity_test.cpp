// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/leads/edge_polarity.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

constexpr int off_polarity = 0;
constexpr int on_polarity = 1;

/// Piece 0 makes ON events as it goes along its normal, piece 1 OFF events.
EdgePolarity of_a_bright_and_a_dark_side() {
    EdgePolarity edges;
    edges.restart(3);
    for (int i = 0; i < 1000; ++i) {
        const double side = i / 100 % 2 == 0 ? 1 : -1;
        edges.learn(0, side > 0 ? on_polarity : off_polarity, side, 1);
        edges.learn(1, side > 0 ? off_polarity : on_polarity, side, 1);
    }
    return edges;
}

TEST(EdgePolarity, says_nothing_of_an_edge_that_it_does_not_know) {
    const EdgePolarity edges = of_a_bright_and_a_dark_side();
    for (const double side : {-1.0, -0.3, 0.0, 1.0}) {
        for (const int polarity : {off_polarity, on_polarity}) {
            EXPECT_EQ(edges.tell(2, polarity, side).gone, side);
            EXPECT_EQ(edges.tell(2, polarity, side).likelihood, 1);
        }
    }
}

TEST(EdgePolarity, tells_the_way_of_a_piece_of_which_nothing_else_does) {
    const EdgePolarity edges = of_a_bright_and_a_dark_side();
    EXPECT_GT(edges.tell(0, on_polarity, 0).gone, 0.9);
    EXPECT_LT(edges.tell(0, off_polarity, 0).gone, -0.9);
    EXPECT_LT(edges.tell(1, on_polarity, 0).gone, -0.9);
    EXPECT_GT(edges.tell(1, off_polarity, 0).gone, 0.9);
}

TEST(EdgePolarity, tells_that_a_piece_came_back_before_its_way_does) {
    const EdgePolarity edges = of_a_bright_and_a_dark_side();
    EXPECT_LT(edges.tell(0, off_polarity, 0.5).gone, -0.8);
    EXPECT_LT(edges.tell(0, off_polarity, 1).gone, 0);
}

TEST(EdgePolarity, holds_an_event_of_the_wrong_polarity_for_less_likely_its_own) {
    const EdgePolarity edges = of_a_bright_and_a_dark_side();
    EXPECT_GT(edges.tell(0, on_polarity, 1).likelihood, 1.7);
    EXPECT_LT(edges.tell(0, off_polarity, 1).likelihood, 0.3);
    EXPECT_EQ(edges.tell(0, off_polarity, 0).likelihood, 1);
}

TEST(EdgePolarity, learns_anew_what_the_background_makes_of_an_edge) {
    EdgePolarity edges = of_a_bright_and_a_dark_side();
    for (int i = 0; i < 300; ++i) edges.learn(0, off_polarity, 1, 1);
    EXPECT_LT(edges.tell(0, on_polarity, 0).gone, -0.7);
}

TEST(EdgePolarity, learns_nothing_from_an_event_that_is_none_of_the_objects) {
    EdgePolarity edges = of_a_bright_and_a_dark_side();
    const double before = edges.tell(0, on_polarity, 0).gone;
    for (int i = 0; i < 300; ++i) edges.learn(0, off_polarity, 1, 0);
    EXPECT_EQ(edges.tell(0, on_polarity, 0).gone, before);
}

TEST(EdgePolarity, knows_nothing_after_a_restart) {
    EdgePolarity edges = of_a_bright_and_a_dark_side();
    edges.restart(3);
    EXPECT_EQ(edges.tell(0, on_polarity, 0).gone, 0);
}

}  // namespace
}  // namespace pursuit::tracker
