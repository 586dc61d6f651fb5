// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pixels/last_events.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace pursuit::tracker {
namespace {

using Box = LastEvents::Box;

std::vector<Event> looked_at(LastEvents& last, const Box& box, std::int64_t since_us) {
    std::vector<Event> events;
    last.for_each_in(box, since_us, [&](const Event& event) { events.push_back(event); });
    return events;
}

TEST(LastEvents, are_none_before_the_first_and_after_a_restart) {
    LastEvents last;
    EXPECT_TRUE(looked_at(last, {0, 0, 1280, 720}, 0).empty());
    last.see({5, 7, 8, 1});
    EXPECT_EQ(looked_at(last, {0, 0, 1280, 720}, 0).size(), 1U);
    last.restart();
    EXPECT_TRUE(looked_at(last, {0, 0, 1280, 720}, 0).empty());
}

TEST(LastEvents, in_a_box_and_since_a_time_are_those_that_brute_force_finds) {
    LastEvents last;
    std::vector<Event> all;
    std::mt19937 random(7);
    std::uniform_int_distribution<int> x(0, 1279);
    std::uniform_int_distribution<int> y(0, 719);
    std::int64_t t_us = 0;
    // Looked through before the ring is full, and when it has gone round.
    for (const std::size_t more : {3U, 5U, 40U, 9'000U, 9'001U, 16'384U, 17U, 50'000U}) {
        for (std::size_t i = 0; i < more; ++i) {
            t_us += static_cast<std::int64_t>(random() % 3);
            all.push_back({t_us, static_cast<std::uint16_t>(x(random)),
                           static_cast<std::uint16_t>(y(random)), 1});
            last.see(all.back());
        }
        for (int trial = 0; trial < 20; ++trial) {
            const auto left = static_cast<std::uint16_t>(x(random));
            const auto top = static_cast<std::uint16_t>(y(random));
            Box box{left, top, static_cast<std::uint16_t>(left + x(random) / 4),
                    static_cast<std::uint16_t>(top + y(random) / 4)};
            if (trial == 0) box = {0, 0, 1280, 720};
            if (trial == 1) box = {left, top, left, top};
            const std::int64_t since_us =
                trial % 3 == 0 ? 0 : t_us - static_cast<std::int64_t>(random() % 20'000);
            std::vector<Event> expected;
            for (std::size_t i = all.size() - std::min(all.size(), LastEvents::most);
                 i < all.size(); ++i) {
                const Event& event = all[i];
                if (event.t_us >= since_us && event.x >= box.left && event.x < box.right &&
                    event.y >= box.top && event.y < box.bottom) {
                    expected.push_back(event);
                }
            }
            EXPECT_EQ(looked_at(last, box, since_us), expected);
        }
    }
}

}  // namespace
}  // namespace pursuit::tracker
