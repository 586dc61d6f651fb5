// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/health.hpp"

#include <gtest/gtest.h>

#include <random>

#include "services/tracker/core/parameters.hpp"

namespace pursuit::tracker {
namespace {

TEST(Health, tells_events_on_the_contour_from_events_anywhere) {
    std::mt19937 random(1);
    Health on_it;
    Health anywhere;
    for (int i = 0; i < 1000; ++i) {
        const double uniform = static_cast<double>(random()) / 4294967296.0;
        on_it.count(1.2 * uniform < 1 ? 1 : 0, 1, i);
        anywhere.count(4 * uniform < 1 ? 1 : 0, 1, i);
    }
    EXPECT_TRUE(on_it.is_settled());
    EXPECT_TRUE(on_it.is_good());
    EXPECT_TRUE(anywhere.is_below(ObjectParameters().let_go_sharpness));
}

TEST(Health, says_the_same_of_events_counted_together_as_one_by_one) {
    std::mt19937 random(2);
    Health alone;
    Health together;
    int sharp = 0;
    for (int i = 1; i <= 4000; ++i) {
        const bool is_sharp = random() % 3 != 0;
        alone.count(is_sharp ? 1 : 0, 1, 20 * i);
        sharp += is_sharp ? 1 : 0;
        if (i % 8 != 0) continue;
        together.count(sharp, 8, 20 * i);
        sharp = 0;
    }
    EXPECT_NEAR(together.sharpness(), alone.sharpness(), 0.02);
    EXPECT_NEAR(together.relative_sharpness(), alone.relative_sharpness(), 0.03);
    EXPECT_NEAR(together.rate_hz(80'000) / alone.rate_hz(80'000), 1, 0.02);
    EXPECT_NEAR(together.usual_rate_hz() / alone.usual_rate_hz(), 1, 0.02);
}

}  // namespace
}  // namespace pursuit::tracker
