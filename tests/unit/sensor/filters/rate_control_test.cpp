// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/rate_control.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/unit/sensor/filters/filter_rule.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;
using Events = std::vector<Event>;

TEST(RateControl, never_passes_more_in_a_window_than_the_limit_and_all_below_it) {
    for (const int mean_step_us : {1, 5, 30}) {
        const auto events = random_events(5000, small, 4, mean_step_us);
        const auto begin_us = events.front().t_us;
        const auto windows = [&](const Events& all) {
            std::map<std::int64_t, int> counts;
            for (const auto& event : all) ++counts[(event.t_us - begin_us) / 1000];
            return counts;
        };
        const auto kept =
            passed(*made("rate_control max_rate_hz=100000 window_us=1000"), events, 61);
        EXPECT_EQ(passed(*made("rate_control max_rate_hz=100000 window_us=1000"), events, 1), kept);
        const auto before = windows(events);
        auto after = windows(kept);
        for (const auto& [window, count] : before) {
            EXPECT_LE(after[window], 100);
            const auto previous = before.find(window - 1);
            const bool thinned = previous != before.end() && previous->second > 100;
            // As many as the share of the window before lets through, unless that is all.
            const int share = thinned ? count * 100 / previous->second : count;
            EXPECT_EQ(after[window], std::min(share, 100));
        }
    }
}

TEST(RateControl, thins_evenly_over_the_window) {
    Events events;
    for (std::int64_t t_us = 0; t_us < 3000; ++t_us) events.push_back({t_us, 0, 0, 1});
    const auto kept = passed(*made("rate_control max_rate_hz=250000 window_us=1000"), events, 100);
    ASSERT_EQ(kept.size(), 750U);
    EXPECT_EQ(kept[249].t_us, 249);  // the first window was not foreseen
    for (std::size_t i = 251; i < kept.size(); ++i) {
        EXPECT_EQ(kept[i].t_us - kept[i - 1].t_us, 4);
    }
}

TEST(RateControl, refuses_a_limit_of_less_than_one_event_a_window) {
    const auto refused =
        make_filter(*parse_filter("rate_control max_rate_hz=999 window_us=1000"), small);
    EXPECT_THAT(refused.error().message, HasSubstr("max_rate_hz is 999, must be at least 1000"));
}

}  // namespace
}  // namespace pursuit::sensor
