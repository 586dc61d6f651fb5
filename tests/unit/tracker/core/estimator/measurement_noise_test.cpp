// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/estimator/measurement_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pursuit::tracker {
namespace {

// Of a model that its events fit as usual.
MeasurementNoise settled() {
    MeasurementNoise noise;
    const double r_px = 0.4 * std::sqrt(1.3);
    for (int i = 0; i < 20'000; ++i) noise.learn(r_px, noise.at(r_px, 0, false), 1);
    return noise;
}

TEST(MeasurementNoise, tells_densities_that_integrate_to_one) {
    MeasurementNoise noise;
    for (const bool is_subsequent : {false, true}) {
        double sum = 0;
        for (double r_px = -20; r_px < 20; r_px += 0.01) {
            sum += 0.01 * noise.at(r_px, 0.05, is_subsequent).likelihood();
        }
        EXPECT_NEAR(sum, 1, 1e-3);
    }
}

TEST(MeasurementNoise, takes_what_strays_for_the_tail) {
    MeasurementNoise noise = settled();
    const auto near = noise.at(0.1, 0.02, false);
    const auto stray = noise.at(2.5, 0.02, false);
    EXPECT_GT(near.near_likelihood, 5 * near.tail_likelihood);
    EXPECT_LT(stray.near_likelihood, 0.01 * stray.tail_likelihood);
    // The measurement counts as the one or the other.
    EXPECT_NEAR(near.variance_px2(), near.near_px2, 0.2 * near.near_px2);
    EXPECT_NEAR(stray.variance_px2(), stray.far_px2, 0.1 * stray.far_px2);
}

TEST(MeasurementNoise, tells_the_share_of_the_object_over_the_variance_at_once) {
    MeasurementNoise noise;
    for (const double r_px : {0.0, 0.4, 1.7, 4.0}) {
        for (const double clutter : {0.002, 0.1, 3.0}) {
            const auto told = noise.at(r_px, 0.03, false);
            const double own = 0.3 * told.likelihood();
            EXPECT_NEAR(told.share_per_variance(0.3, clutter, 0.03) * (0.03 + told.variance_px2()),
                        own / (own + clutter), 1e-12);
        }
    }
}

TEST(MeasurementNoise, takes_the_state_s_uncertainty_into_account_as_soon_as_it_changes) {
    MeasurementNoise noise = settled();
    // Within a tenth of the variance it is taken for what it was.
    for (const double state_px2 : {0.01, 1.0, 0.02, 0.3, 0.01}) {
        const double variance_px2 = state_px2 + 0.4 * 0.4;
        EXPECT_NEAR(noise.at(0, state_px2, false).half_per_variance * 2 * variance_px2, 1, 0.1)
            << state_px2;
    }
}

TEST(MeasurementNoise, trusts_first_events_more_than_subsequent_ones) {
    MeasurementNoise noise;
    EXPECT_LT(noise.at(0, 0, false).near_px2, noise.at(0, 0, true).near_px2);
}

TEST(MeasurementNoise, learns_the_variance_of_what_comes) {
    std::mt19937 random(3);
    for (const double sigma_px : {0.25, 0.4, 0.8}) {
        MeasurementNoise noise;
        std::normal_distribution<double> residual_px(0, sigma_px);
        for (int i = 0; i < 30'000; ++i) {
            const double r_px = residual_px(random);
            noise.learn(r_px, noise.at(r_px, 0, false), 1);
        }
        // It settles where the mean squared residual is 1.3 of it.
        EXPECT_NEAR(noise.at(0, 0, false).near_px2 / (sigma_px * sigma_px), 1 / 1.3, 0.1);
    }
}

TEST(MeasurementNoise, stays_within_its_bounds_whatever_comes) {
    MeasurementNoise noise;
    for (int i = 0; i < 100'000; ++i) noise.learn(100, noise.at(100, 0, false), 1);
    EXPECT_EQ(noise.gain(), 16);
    for (int i = 0; i < 100'000; ++i) noise.learn(0, noise.at(0, 0, false), 1);
    EXPECT_EQ(noise.gain(), 0.2);
    noise.restart();
    EXPECT_EQ(noise.gain(), MeasurementNoise().gain());
}

TEST(MeasurementNoise, takes_a_model_for_somewhat_wrong_until_its_events_tell_otherwise) {
    MeasurementNoise noise;
    const double usual_px2 = settled().at(0, 0, false).near_px2;
    const double first_px2 = noise.at(0, 0, false).near_px2;
    EXPECT_GT(first_px2, usual_px2 + 0.35 * 0.35);
    EXPECT_LT(first_px2, usual_px2 + 0.7 * 0.7);
}

TEST(MeasurementNoise, has_a_heavier_and_wider_tail_where_the_model_is_another_than_the_object) {
    MeasurementNoise noise = settled();
    const auto usual = noise.at(4, 0, false);
    for (int i = 0; i < 1000; ++i) noise.learn(4, noise.at(4, 0, false), 1);
    ASSERT_GT(noise.gain(), 5);
    const auto misfit = noise.at(4, 0, false);
    EXPECT_GT((misfit.far_px2 - misfit.near_px2), 2 * (usual.far_px2 - usual.near_px2));
    EXPECT_GT(misfit.tail_likelihood, usual.tail_likelihood);
}

}  // namespace
}  // namespace pursuit::tracker
