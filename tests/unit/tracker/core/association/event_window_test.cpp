// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/event_window.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <utility>
#include <vector>

namespace pursuit::tracker {
namespace {

// What a window should hold: the events one by one.
struct Recount {
    Recount(std::int64_t window, std::size_t most, bool last_only)
        : window_us(window), limit(most), is_last_per_pixel(last_only) {}

    PlaneSums add(const Event& event) {
        events.push_back(event);
        if (events.size() > limit) events.erase(events.begin());
        std::erase_if(events, [&](const Event& e) { return e.t_us < event.t_us - window_us; });
        PlaneSums sums;
        std::map<std::pair<int, int>, Event> last;
        for (const Event& e : events) last[{e.x, e.y}] = e;
        for (const Event& e : events) {
            if (is_last_per_pixel && !(last[{e.x, e.y}] == e)) continue;
            sums.add(e.x, e.y, e.t_us);
        }
        return sums;
    }

    std::int64_t window_us;
    std::size_t limit;
    bool is_last_per_pixel;
    std::vector<Event> events;
};

class Window : public testing::TestWithParam<bool> {};

TEST_P(Window, holds_what_a_recount_of_its_events_gives) {
    // Limits that bind and that do not; storage that grows while pixels fire again and again.
    for (const auto& [window_us, limit] :
         {std::pair<std::int64_t, std::size_t>{700, 50}, {300, 5000}, {100'000, 1500}}) {
        EventWindow window(window_us, limit, GetParam());
        Recount recount(window_us, limit, GetParam());
        std::mt19937 random(7);
        std::int64_t t_us = 0;
        for (int i = 0; i < 3000; ++i) {
            t_us += 1 + random() % 3 + (random() % 500 == 0 ? 800 : 0);
            const Event event{t_us, static_cast<std::uint16_t>(random() % 16),
                              static_cast<std::uint16_t>(random() % 8), 1};
            window.add(event);
            const PlaneSums expected = recount.add(event);
            ASSERT_EQ(window.sums().count(), expected.count()) << i;
            if (i % 10 != 0 || expected.count() < 3) continue;
            const auto plane = window.sums().fit(1e-2, t_us);
            const auto expected_plane = expected.fit(1e-2, t_us);
            ASSERT_EQ(plane->normal, expected_plane->normal) << i;
            ASSERT_EQ(plane->centre_px, expected_plane->centre_px) << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(EveryEventOrTheLastOfAPixel, Window, testing::Bool(),
                         [](const auto& made) { return made.param ? "last" : "every"; });

TEST(Window, is_whole_once_fed_for_its_length_and_begins_anew_when_it_ran_empty) {
    EventWindow window(1000, 100, false);
    EXPECT_FALSE(window.is_whole(0));
    for (std::int64_t t_us = 500; t_us <= 1499; ++t_us) window.add({t_us, 1, 1, 1});
    EXPECT_FALSE(window.is_whole(1499));
    EXPECT_TRUE(window.is_whole(1500));
    window.reach(2500);
    EXPECT_EQ(window.sums().count(), 0U);
    EXPECT_FALSE(window.is_whole(2500));
    window.add({2600, 1, 1, 1});
    EXPECT_FALSE(window.is_whole(3599));
    EXPECT_TRUE(window.is_whole(3600));
}

}  // namespace
}  // namespace pursuit::tracker
