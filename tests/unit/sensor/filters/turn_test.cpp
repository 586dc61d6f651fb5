// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/turn.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/unit/sensor/filters/filter_rule.hpp"

namespace pursuit::sensor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Where a pixel of a 4x3 image goes: two corners tell any of the eight orientations.
void expect_turn(const std::string& text, Geometry output, Event top_left, Event second) {
    const auto filter = made("geometry " + text, {4, 3});
    EXPECT_EQ(filter->geometry(), output) << text;
    EXPECT_THAT(passed(*filter, {{1, 0, 0, 1}, {1, 1, 0, 1}}, 2), ElementsAre(top_left, second))
        << text;
}

TEST(Turn, lays_the_image_in_each_of_its_eight_ways) {
    expect_turn("", {4, 3}, {1, 0, 0, 1}, {1, 1, 0, 1});
    expect_turn("flip_x=1", {4, 3}, {1, 3, 0, 1}, {1, 2, 0, 1});
    expect_turn("flip_y=1", {4, 3}, {1, 0, 2, 1}, {1, 1, 2, 1});
    expect_turn("rotate_deg=180", {4, 3}, {1, 3, 2, 1}, {1, 2, 2, 1});
    expect_turn("transpose=1", {3, 4}, {1, 0, 0, 1}, {1, 0, 1, 1});
    // Clockwise: the top-left corner comes to the top right, its right neighbour below it.
    expect_turn("rotate_deg=90", {3, 4}, {1, 2, 0, 1}, {1, 2, 1, 1});
    expect_turn("rotate_deg=270", {3, 4}, {1, 0, 3, 1}, {1, 0, 2, 1});
    expect_turn("transpose=1 rotate_deg=180", {3, 4}, {1, 2, 3, 1}, {1, 2, 2, 1});
}

TEST(Turn, keeps_every_event_inside_its_image_and_is_undone_by_its_opposite) {
    const auto events = random_events(2000, small, 2);
    for (const auto& [there, back] :
         std::map<std::string, std::string>{{"rotate_deg=90", "rotate_deg=270"},
                                            {"rotate_deg=90 flip_x=1", "transpose=1"},
                                            {"transpose=1", "transpose=1"},
                                            {"flip_x=1 flip_y=1", "rotate_deg=180"}}) {
        const auto first = made("geometry " + there);
        const auto turned = passed(*first, events, 99);
        for (const auto& event : turned) {
            ASSERT_LT(event.x, first->geometry().width);
            ASSERT_LT(event.y, first->geometry().height);
        }
        const auto second = made("geometry " + back, first->geometry());
        EXPECT_EQ(second->geometry(), small);
        EXPECT_EQ(passed(*second, turned, 99), events) << there << " then " << back;
    }
}

TEST(Turn, refuses_odd_angles_and_an_image_with_more_rows_than_a_packet_can_name) {
    EXPECT_THAT(make_filter(*parse_filter("geometry rotate_deg=45"), small).error().message,
                HasSubstr("rotate_deg is 45, must be 0, 90, 180 or 270"));
    EXPECT_THAT(make_filter(*parse_filter("geometry transpose=1"), {32769, 2}).error().message,
                HasSubstr("at most 32768"));
    EXPECT_TRUE(make_filter(*parse_filter("geometry transpose=1"), {32768, 2}));
}

}  // namespace
}  // namespace pursuit::sensor
