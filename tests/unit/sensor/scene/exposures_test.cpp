// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/exposures.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace pursuit::sensor {
namespace {

constexpr Geometry geometry{8, 4};

std::vector<Event> taken(Exposures& exposures, std::int64_t end_us) {
    std::vector<Event> crossings;
    exposures.take(end_us, crossings);
    return crossings;
}

TEST(Exposures, last_the_longer_the_darker) {
    Exposures exposures(geometry, 1000);
    exposures.start(9, 100, 1);
    exposures.start(10, 100, 0.25F);
    const auto crossings = taken(exposures, 100'000);
    ASSERT_EQ(crossings.size(), 4U);
    EXPECT_EQ(crossings[0], (Event{200, 1, 1, 0}));
    EXPECT_EQ(crossings[1], (Event{500, 2, 1, 0}));
    EXPECT_EQ(crossings[2], (Event{1200, 1, 1, 1}));
    EXPECT_EQ(crossings[3], (Event{4500, 2, 1, 1}));
    EXPECT_TRUE(taken(exposures, 200'000).empty());
}

TEST(Exposures, are_given_up_for_the_next_one_of_their_pixel) {
    Exposures exposures(geometry, 1000);
    exposures.start(0, 0, 1);
    exposures.start(0, 50, 1);    // before the first crossing
    exposures.start(0, 600, 1);   // between the crossings
    exposures.start(0, 5000, 1);  // after both
    std::vector<std::pair<std::int64_t, int>> found;
    for (const auto& e : taken(exposures, 100'000)) found.emplace_back(e.t_us, e.polarity);
    const std::vector<std::pair<std::int64_t, int>> expected{
        {150, 0}, {700, 0}, {1700, 1}, {5100, 0}, {6100, 1}};
    EXPECT_EQ(found, expected);
}

TEST(Exposures, are_the_same_however_they_are_taken) {
    const auto all = [](std::int64_t step_us) {
        Exposures exposures(geometry, 700);
        std::vector<Event> crossings;
        for (std::int64_t t_us = 0; t_us < 20'000; t_us += 10) {
            if (t_us % step_us == 0) exposures.take(t_us, crossings);
            const auto index = static_cast<std::uint32_t>(t_us * 7 / 30 % 32);
            exposures.start(index, t_us, 0.1F + 0.1F * static_cast<float>(t_us % 9));
        }
        exposures.take(1'000'000, crossings);
        return crossings;
    };
    const auto whole = all(1'000'000);
    EXPECT_GT(whole.size(), 100U);
    EXPECT_EQ(all(10), whole);
    EXPECT_EQ(all(370), whole);
    EXPECT_TRUE(std::is_sorted(whole.begin(), whole.end(),
                               [](const Event& a, const Event& b) { return a.t_us < b.t_us; }));
}

}  // namespace
}  // namespace pursuit::sensor
