// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/refractory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <map>

#include "tests/unit/sensor/filters/filter_rule.hpp"

namespace pursuit::sensor {
namespace {

using testing::ElementsAre;
using Events = std::vector<Event>;

/// The rule has memory: what passed is kept beside, in a map by pixel (and polarity).
TEST(Refractory, passes_a_pixel_again_when_the_period_is_over_not_before) {
    for (const bool by_polarity : {false, true}) {
        for (const std::int64_t period_us : {1, 100, 3000, 1'000'000'000}) {
            std::map<std::array<int, 3>, std::int64_t> passed_us;
            expect_rule("refractory period_us=" + std::to_string(period_us) +
                            " by_polarity=" + std::to_string(by_polarity),
                        [&](const Events& events, std::size_t i) {
                            if (i == 0) passed_us.clear();
                            const auto [t_us, x, y, p] = events[i];
                            const std::array pixel{int{x}, int{y}, by_polarity ? int{p} : 0};
                            const auto last = passed_us.find(pixel);
                            if (last != passed_us.end() && t_us < last->second + period_us) {
                                return false;
                            }
                            passed_us[pixel] = t_us;
                            return true;
                        });
        }
    }
}

TEST(Refractory, measures_from_the_last_event_that_passed) {
    const Events events{
        {0, 1, 1, 1}, {60, 1, 1, 1}, {100, 1, 1, 1}, {199, 1, 1, 0}, {200, 1, 1, 0}};
    EXPECT_THAT(passed(*made("refractory period_us=100"), events, 9),
                ElementsAre(events[0], events[2], events[4]));
}

}  // namespace
}  // namespace pursuit::sensor
