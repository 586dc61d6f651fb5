// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pixels/recent_pixels.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

namespace pursuit::tracker {
namespace {

TEST(RecentPixels, tells_of_a_pixel_that_has_not_fired_that_it_never_did) {
    RecentPixels recent;
    recent.restart({4, 3});
    const PixelPast past = recent.note({0, 3, 2, 1});
    EXPECT_GE(past.since_same_us, PixelPast::never_us);
    EXPECT_GE(past.since_other_us, PixelPast::never_us);
    EXPECT_FALSE(recent.is_blind({0, 0}, 0));
}

TEST(RecentPixels, keep_pixels_and_polarities_apart) {
    RecentPixels recent;
    recent.restart({4, 3});
    EXPECT_GT(recent.note({100, 3, 2, 1}).since_same_us, 1'000'000'000);
    EXPECT_GT(recent.note({110, 3, 2, 0}).since_same_us, 1'000'000'000);
    EXPECT_GT(recent.note({120, 2, 2, 1}).since_other_us, 1'000'000'000);
    const PixelPast past = recent.note({150, 3, 2, 1});
    EXPECT_EQ(past.since_same_us, 50);
    EXPECT_EQ(past.since_other_us, 40);
}

TEST(RecentPixels, agrees_with_a_plain_record_of_every_event_and_forgets_it_with_the_stream) {
    RecentPixels recent;
    std::mt19937 random(1);
    recent.reserve({400, 300});
    // The table is kept where it is large enough, and all of it has to be zero again.
    for (const Geometry geometry : {Geometry{37, 23}, Geometry{304, 240}, Geometry{37, 23},
                                    Geometry{304, 240}, Geometry{640, 480}, Geometry{304, 240}}) {
        recent.restart(geometry);
        std::map<std::tuple<int, int, int>, std::int64_t> last_us;
        std::int64_t t_us = 0;
        for (int i = 0; i < 20'000; ++i) {
            t_us += random() % 3;
            const Event event{t_us, static_cast<std::uint16_t>(random() % geometry.width),
                              static_cast<std::uint16_t>(random() % geometry.height),
                              static_cast<std::uint8_t>(random() % 2)};
            const auto since_us = [&](int polarity) {
                const auto found = last_us.find({event.x, event.y, polarity});
                return found == last_us.end() ? PixelPast::never_us + t_us : t_us - found->second;
            };
            const PixelPast past = recent.note(event);
            ASSERT_EQ(past.since_same_us, since_us(event.polarity));
            ASSERT_EQ(past.since_other_us, since_us(1 - event.polarity));
            last_us[{event.x, event.y, event.polarity}] = t_us;
        }
    }
}

TEST(RecentPixels, knows_a_pixel_as_blind_until_its_refractory_period_is_over) {
    RecentPixels recent;
    recent.restart({8, 8});
    recent.note({1'000'000, 5, 6, 0});
    const double blind_us = recent.blind_us();
    EXPECT_TRUE(recent.is_blind({5.4, 5.6}, 1e6 + 0.9 * blind_us));
    EXPECT_FALSE(recent.is_blind({5.4, 5.6}, 1e6 + 1.1 * blind_us));
    EXPECT_FALSE(recent.is_blind({4, 6}, 1e6 + 1));
    for (const double outside_px : {-3.0, 8.0, 1e9}) {
        EXPECT_FALSE(recent.is_blind({outside_px, 6}, 1e6 + 1));
        EXPECT_FALSE(recent.is_blind({5, outside_px}, 1e6 + 1));
    }
}

}  // namespace
}  // namespace pursuit::tracker
