// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/background_activity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <map>

#include "tests/unit/sensor/filters/filter_rule.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;
using Events = std::vector<Event>;

TEST(BackgroundActivity, counts_the_pixels_around_that_fired_within_the_window) {
    for (const bool same_polarity : {false, true}) {
        for (const auto& [radius, support, window_us] : {std::array{1, 1, 100},
                                                         {1, 3, 2000},
                                                         {2, 1, 500},
                                                         {3, 6, 400},
                                                         {1, 8, 20000},
                                                         {2, 3, 1'000'000'000}}) {
            const std::string text = "background_activity window_us=" + std::to_string(window_us) +
                                     " radius_px=" + std::to_string(radius) +
                                     " support=" + std::to_string(support) +
                                     " same_polarity=" + std::to_string(same_polarity);
            const auto rule = [&, r = radius, s = support, w = window_us](const Events& events,
                                                                          std::size_t i) {
                const auto& event = events[i];
                std::map<std::array<int, 2>, bool> active;
                for (std::size_t j = i; j-- > 0 && events[j].t_us >= event.t_us - w;) {
                    const auto& other = events[j];
                    const bool same = other.x == event.x && other.y == event.y;
                    if (std::abs(other.x - event.x) <= r && std::abs(other.y - event.y) <= r &&
                        !same && (!same_polarity || other.polarity == event.polarity)) {
                        active[{other.x, other.y}] = true;
                    }
                }
                return static_cast<int>(active.size()) >= s;
            };
            expect_rule(text, rule);
        }
    }
}

TEST(BackgroundActivity, refuses_more_support_than_there_are_neighbours) {
    const auto refused = make_filter(*parse_filter("background_activity support=9"), small);
    EXPECT_THAT(refused.error().message, HasSubstr("support is 9, must be at most 8"));
    EXPECT_TRUE(make_filter(*parse_filter("background_activity support=24 radius_px=2"), small));
}

}  // namespace
}  // namespace pursuit::sensor
