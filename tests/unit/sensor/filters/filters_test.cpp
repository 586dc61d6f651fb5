// SPDX-License-Identifier: Apache-2.0
// What holds of all filters, and those that judge an event by itself alone.
#include "services/sensor/filters/filters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/sensor/filters/filter_rule.hpp"

namespace pursuit::sensor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Events = std::vector<Event>;

TEST(Filters, give_nothing_for_nothing_and_keep_time_and_order) {
    for (const auto& kind : filter_kinds()) {
        if (kind.takes_file) continue;
        const auto filter = made(std::string(kind.name));
        EXPECT_EQ(filter->apply({}), 0U) << kind.name;
        const auto kept = passed(*filter, random_events(1000, small, 5), 100);
        EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end(), [](const auto& a, const auto& b) {
            return a.t_us < b.t_us;
        })) << kind.name;
    }
}

TEST(RegionOfInterest, keeps_its_rectangle_with_its_first_and_without_its_end) {
    expect_rule("region_of_interest x_px=3 y_px=5 width_px=10 height_px=4",
                [](const Events& events, std::size_t i) {
                    const auto [t, x, y, p] = events[i];
                    return x >= 3 && x <= 12 && y >= 5 && y <= 8;
                });
    expect_rule("region_of_interest x_px=3 y_px=5 width_px=10 height_px=4 outside=1",
                [](const Events& events, std::size_t i) {
                    const auto [t, x, y, p] = events[i];
                    return x < 3 || x > 12 || y < 5 || y > 8;
                });
    expect_rule("region_of_interest", [](const Events&, std::size_t) { return true; });
}

TEST(RegionOfInterest, that_begins_outside_the_image_is_refused_with_the_bound) {
    const auto refused = make_filter(*parse_filter("region_of_interest x_px=24"), small);
    EXPECT_THAT(refused.error().message, HasSubstr("x_px is 24, must be less than 24"));
    EXPECT_TRUE(make_filter(*parse_filter("region_of_interest x_px=23 y_px=17"), small));
    EXPECT_FALSE(make_filter(*parse_filter("region_of_interest y_px=18"), small));
}

TEST(Polarity, keeps_one_of_the_two_and_exchanges_them) {
    const Events events{{1, 0, 0, 0}, {2, 1, 0, 1}, {2, 2, 0, 1}};
    EXPECT_EQ(passed(*made("polarity"), events, 9), events);
    EXPECT_THAT(passed(*made("polarity keep=0"), events, 9), ElementsAre(events[0]));
    EXPECT_THAT(passed(*made("polarity keep=1"), events, 9), ElementsAre(events[1], events[2]));
    EXPECT_THAT(passed(*made("polarity keep=1 invert=1"), events, 1),
                ElementsAre(Event{2, 1, 0, 0}, Event{2, 2, 0, 0}));
}

}  // namespace
}  // namespace pursuit::sensor
