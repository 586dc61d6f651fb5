// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/estimator/quiet_facings.hpp"

#include <gtest/gtest.h>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

constexpr double step_s = 0.001;
constexpr double going_px_s = 20;
constexpr double events_per_px = 40;  // of each side

/// A square of 40 px whose sides make events as it goes, told to what listens.
class QuietSquare : public testing::Test {
 protected:
    using Filter = TwistFilter<TransformKind::isometry>;
    using Step = Filter::Step;

    QuietSquare() : contour_(test::square()), quiet_(contour_) {
        for (std::size_t i = 0; i < contour_.pieces().pieces().size(); ++i) {
            const Piece& piece = contour_.pieces().pieces()[i];
            const bool is_upright = piece.ax == piece.bx;
            (is_upright ? upright_ : level_).push_back(static_cast<std::int32_t>(i));
        }
        go(going_px_s, going_px_s);
    }

    /// The filter thinks that it goes so fast, give or take sigma.
    void go(double vx, double vy, double sigma = 15) {
        filter_.restart({}, Step(vx, vy, 0), Step(0.1, 0.1, 0.003), Step(sigma, sigma, sigma / 20));
    }

    /// For so long upright sides go across themselves at vx, level ones at vy, and make events.
    void pass(double time_s, double vx, double vy, bool is_whole = true) {
        for (double t_s = 0; t_s < time_s; t_s += step_s) {
            hear(upright_, vx);
            hear(level_, vy);
            if (quiet_.wait(step_s)) quiet_.look(filter_, 1.0 / (20 * 20), is_whole);
        }
    }

    void learn_both_ways() { pass(1, going_px_s, going_px_s); }

    Filter filter_;
    Contour contour_;
    QuietFacings<TransformKind::isometry> quiet_;

 private:
    void hear(const std::vector<std::int32_t>& pieces, double speed) {
        for (const std::int32_t piece : pieces) {
            quiet_.hear(piece, events_per_px * std::abs(speed) * step_s);
        }
    }
    std::vector<std::int32_t> upright_;
    std::vector<std::int32_t> level_;
};

TEST_F(QuietSquare, goes_on_as_long_as_its_sides_make_events) {
    learn_both_ways();
    EXPECT_EQ(filter_.twist(), Step(going_px_s, going_px_s, 0));
}

TEST_F(QuietSquare, stops_in_the_direction_in_which_no_events_come_and_goes_on_in_the_other) {
    learn_both_ways();
    pass(0.02, going_px_s, 0);
    EXPECT_LT(filter_.twist().y(), 0.2 * going_px_s);
    EXPECT_NEAR(filter_.twist().x(), going_px_s, 0.5);
}

TEST_F(QuietSquare, is_thought_to_have_turned_rather_than_stopped) {
    learn_both_ways();
    pass(0.02, going_px_s, 0);
    EXPECT_LT(filter_.twist().y(), 0);
    EXPECT_GT(filter_.twist().y(), -0.5 * going_px_s);
}

TEST_F(QuietSquare, is_stopped_by_no_silence_that_chance_explains) {
    learn_both_ways();
    pass(0.001, going_px_s, 0);
    EXPECT_EQ(filter_.twist().y(), going_px_s);
}

TEST_F(QuietSquare, leaves_the_filter_as_unsure_as_it_was) {
    learn_both_ways();
    const double before = filter_.covariance()(4, 4);
    pass(0.02, going_px_s, 0);
    EXPECT_GE(filter_.covariance()(4, 4), before);
}

TEST_F(QuietSquare, goes_on_where_it_surely_does_and_has_lost_its_contrast) {
    learn_both_ways();
    go(going_px_s, going_px_s, 2);
    pass(0.02, going_px_s, 0);
    EXPECT_EQ(filter_.twist().y(), going_px_s);
}

TEST_F(QuietSquare, goes_on_where_a_part_of_it_is_hidden) {
    learn_both_ways();
    pass(0.02, going_px_s, 0, false);
    EXPECT_EQ(filter_.twist().y(), going_px_s);
}

TEST_F(QuietSquare, knows_nothing_of_a_side_that_never_made_events) {
    pass(1, going_px_s, 0);
    EXPECT_EQ(filter_.twist().y(), going_px_s);
}

TEST_F(QuietSquare, knows_nothing_after_a_restart) {
    learn_both_ways();
    quiet_.restart();
    pass(0.02, going_px_s, 0);
    EXPECT_EQ(filter_.twist().y(), going_px_s);
}

}  // namespace
}  // namespace pursuit::tracker
