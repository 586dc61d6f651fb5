// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/tally.hpp"

#include <gtest/gtest.h>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

TEST(Going, makes_events_of_what_moves_across_itself_alone) {
    const Outline::Part upright{{10, 0}, {0, 4}};
    const Going to_the_right{Eigen::Matrix2d::Identity(), {100, 0, 0, 0, 0}};
    const Going up{Eigen::Matrix2d::Identity(), {0, 100, 0, 0, 0}};
    const Going turning{Eigen::Matrix2d::Identity(), {0, 0, 2, 0, 0}};
    EXPECT_DOUBLE_EQ(to_the_right.across_px_s(upright, {10, 0}), 400);
    EXPECT_DOUBLE_EQ(up.across_px_s(upright, {10, 0}), 0);
    EXPECT_DOUBLE_EQ(turning.across_px_s(upright, {10, 0}), 0);
    EXPECT_DOUBLE_EQ(turning.across_px_s(upright, {0, 10}), 80);
}

TEST(Going, makes_events_of_what_grows_along_the_axis_that_grows) {
    const Going taller{Eigen::Matrix2d::Identity(), {0, 0, 0, 0, 2}};
    EXPECT_DOUBLE_EQ(taller.across_px_s({{0, 10}, {4, 0}}, {0, 10}), 80);
    EXPECT_DOUBLE_EQ(taller.across_px_s({{10, 0}, {0, 4}}, {10, 0}), 0);
}

TEST(Tally, learns_how_many_events_a_way_makes) {
    Outline outline{Contour(test::arrow())};
    const Going going{Eigen::Matrix2d::Identity(), {100, 40, 0, 0, 0}};
    Tally tally;
    tally.begin(0);
    for (int i = 1; i <= 400; ++i) {
        tally.begin(i * 20'000);
        for (Outline::Part& part : outline.parts()) {
            part.events = 5 * going.across_px_s(part, part.middle_px) * 0.02;
        }
        tally.learn(outline, going);
    }
    // 2000 events of 5 a px² are remembered, beside 200 of 2 that are usual for a start.
    const double told_per_px2 = (2000.0 + 200) / (2000.0 / 5 + 200.0 / 2);
    const Outline::Part& part = outline.parts().front();
    EXPECT_NEAR(tally.expected_events(going, part, part.middle_px) / part.events, told_per_px2 / 5,
                1e-6);
}

TEST(Going, shows_by_how_much_what_is_not_hidden_moves_across_itself) {
    // A square of four sides that goes right: its upright sides show, and a little of the others.
    Outline outline{Contour(test::polygon("square", {{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}))};
    const Going right{Eigen::Matrix2d::Identity(), {100, 0, 0, 0, 0}};
    EXPECT_DOUBLE_EQ(right.visible_share(outline, 7), 1);
    ASSERT_EQ(outline.parts().size() % 4, 0U);
    for (Outline::Part& part : outline.parts()) part.is_hidden = part.middle_px.x() > 4.9;
    EXPECT_NEAR(right.visible_share(outline, 7), (1.1 + 0.1 + 0.1) / 2.4, 1e-6);
    for (Outline::Part& part : outline.parts()) part.is_hidden = true;
    EXPECT_EQ(right.visible_share(outline, 7), 0);
    outline.show_all();
    EXPECT_DOUBLE_EQ(right.visible_share(outline, 7), 1);
}

}  // namespace
}  // namespace pursuit::tracker
