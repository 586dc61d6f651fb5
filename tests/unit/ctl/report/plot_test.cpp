// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/report/plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pursuit::ctl {
namespace {

TEST(Plot, thinning_keeps_extremes_gaps_and_order) {
    std::vector<ReportSample> samples;
    for (int i = 0; i < 10'000; ++i) samples.push_back({i, std::sin(i * 0.001)});
    samples[1234].value = 50;
    samples[5678].value = -50;
    samples[7777].value = std::numeric_limits<double>::quiet_NaN();
    const auto kept = thinned(samples, 300);
    EXPECT_LE(kept.size(), 300U);
    const auto has = [&](std::int64_t t_us) {
        return std::any_of(kept.begin(), kept.end(),
                           [&](const ReportSample& sample) { return sample.t_us == t_us; });
    };
    EXPECT_TRUE(has(1234));
    EXPECT_TRUE(has(5678));
    EXPECT_TRUE(has(7777));
    EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end(),
                               [](const auto& a, const auto& b) { return a.t_us < b.t_us; }));
    EXPECT_EQ(thinned(samples, 10'000).size(), 10'000U);
    EXPECT_TRUE(thinned({}, 10).empty());
}

TEST(Plot, ticks_are_round_and_within_the_axis) {
    EXPECT_EQ(ticks(0, 1), (std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1}));
    EXPECT_EQ(ticks(-3, 12), (std::vector<double>{0, 5, 10}));
    EXPECT_TRUE(ticks(1, 1).empty());
    EXPECT_TRUE(ticks(std::numeric_limits<double>::quiet_NaN(), 1).empty());
    for (const double scale : {1e-9, 0.003, 7.0, 1e12}) {
        const auto values = ticks(-scale, 3 * scale);
        EXPECT_GE(values.size(), 3U);
        EXPECT_LE(values.size(), 7U);
        EXPECT_GE(values.front(), -scale);
        EXPECT_LE(values.back(), 3 * scale * (1 + 1e-9));
    }
}

}  // namespace
}  // namespace pursuit::ctl
