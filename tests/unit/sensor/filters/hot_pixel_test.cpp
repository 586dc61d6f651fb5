// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/hot_pixel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>

#include "tests/unit/sensor/filters/filter_rule.hpp"

namespace pursuit::sensor {
namespace {

using Events = std::vector<Event>;

/// Counts of a window by pixel, found by walking all events for each question.
int count_in_window(const Events& events, std::int64_t window, std::int64_t window_us, int x,
                    int y) {
    const auto begin_us = events.front().t_us + window * window_us;
    return static_cast<int>(std::count_if(events.begin(), events.end(), [&](const Event& event) {
        return event.t_us >= begin_us && event.t_us < begin_us + window_us && event.x == x &&
               event.y == y;
    }));
}

TEST(HotPixel, drops_in_a_window_what_stood_out_in_the_one_before) {
    constexpr std::int64_t window_us = 10'000;
    std::mt19937 random(3);
    auto events = random_events(1500, small, 8, 50);
    // Pixels that fire for a while at a rate of their own: in a corner, at an edge, two together.
    const std::array<std::array<std::uint16_t, 2>, 4> hot{{{0, 0}, {23, 9}, {10, 10}, {11, 10}}};
    const auto first_us = events.front().t_us;
    for (const auto& [x, y] : hot) {
        for (std::int64_t t_us = first_us + 100; t_us < first_us + 45'000; t_us += 150 + x) {
            events.push_back({t_us + static_cast<std::int64_t>(random() % 10), x, y, 1});
        }
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const auto& a, const auto& b) { return a.t_us < b.t_us; });
    Events expected;
    for (const auto& event : events) {
        const auto window = (event.t_us - events.front().t_us) / window_us;
        bool is_hot = false;
        if (window > 0) {
            const int own = count_in_window(events, window - 1, window_us, event.x, event.y);
            int sum = 0, neighbours = 0;
            for (int y = 0; y < small.height; ++y) {
                for (int x = 0; x < small.width; ++x) {
                    const int away = std::max(std::abs(x - event.x), std::abs(y - event.y));
                    if (away != 1) continue;
                    ++neighbours;
                    sum += count_in_window(events, window - 1, window_us, x, y);
                }
            }
            is_hot = own >= 20 && own * neighbours >= 4 * sum;  // 2000 Hz over 10 ms
        }
        if (!is_hot) expected.push_back(event);
    }
    ASSERT_LT(expected.size() + 200, events.size());
    for (const std::size_t at_a_time : {1, 13, 100'000}) {
        const auto filter = made("hot_pixel window_ms=10 rate_hz=2000 ratio=4");
        EXPECT_EQ(passed(*filter, events, at_a_time), expected);
    }
}

TEST(HotPixel, frees_every_pixel_after_a_window_without_events) {
    Events events;
    for (std::int64_t t_us = 0; t_us < 20'000; t_us += 100) events.push_back({t_us, 5, 5, 1});
    events.push_back({45'000, 5, 5, 1});
    const auto filter = made("hot_pixel window_ms=10 rate_hz=1000 ratio=2");
    const auto kept = passed(*filter, events, 50);
    ASSERT_EQ(kept.size(), 101U);  // the first window, and the event after the silence
    EXPECT_EQ(kept.back(), events.back());
}

}  // namespace
}  // namespace pursuit::sensor
