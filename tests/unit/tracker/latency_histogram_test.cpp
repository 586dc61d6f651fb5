// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/latency_histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace pursuit::tracker {
namespace {

TEST(LatencyHistogram, gives_zero_without_samples) {
    const LatencyHistogram histogram;
    EXPECT_EQ(histogram.percentile_us(0.99), 0);
    EXPECT_EQ(histogram.max_us(), 0);
    EXPECT_EQ(histogram.samples(), 0U);
}

TEST(LatencyHistogram, gives_one_sample_as_every_percentile) {
    LatencyHistogram histogram;
    histogram.add(123);
    for (const double share : {0.0, 0.5, 1.0}) EXPECT_EQ(histogram.percentile_us(share), 123);
}

TEST(LatencyHistogram, is_exact_below_16_us_and_never_below_the_truth_nor_a_16th_above) {
    std::mt19937_64 random(1);
    std::vector<std::int64_t> samples;
    LatencyHistogram histogram;
    for (int i = 0; i < 20'000; ++i) {
        const auto us = static_cast<std::int64_t>(random() >> (24 + random() % 40));
        samples.push_back(us);
        histogram.add(us);
    }
    std::sort(samples.begin(), samples.end());
    for (const double share : {0.01, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0}) {
        const auto rank =
            static_cast<std::size_t>(std::ceil(share * static_cast<double>(samples.size())));
        const auto truth = static_cast<double>(samples[rank - 1]);
        EXPECT_GE(histogram.percentile_us(share), truth) << share;
        EXPECT_LE(histogram.percentile_us(share), truth < 16 ? truth : truth * 17 / 16) << share;
    }
    EXPECT_EQ(histogram.max_us(), static_cast<double>(samples.back()));
}

TEST(LatencyHistogram, counts_a_clock_that_was_set_back_as_zero) {
    LatencyHistogram histogram;
    histogram.add(-5);
    EXPECT_EQ(histogram.max_us(), 0);
    EXPECT_EQ(histogram.samples(), 1U);
}

TEST(LatencyHistogram, keeps_the_longest_duration_there_is) {
    LatencyHistogram histogram;
    histogram.add(INT64_MAX);
    EXPECT_EQ(histogram.samples(), 1U);
    EXPECT_GT(histogram.percentile_us(0.5), 1e12);
}

}  // namespace
}  // namespace pursuit::tracker
