// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/look_spacing.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "services/sensor/scene/look_plan.hpp"

namespace pursuit::sensor {
namespace {

constexpr float far_sigmas = 20;

ActivePixels::Pixel pixel_near_edges(float normal_share, float contrast) {
    return {0, 0, 0, 0, 0, normal_share, contrast};
}

/// Share of a Gaussian beyond a straight line at that distance.
double tail_share(double sigmas) { return 0.5 * std::erfc(sigmas / std::sqrt(2.0)); }

TEST(LookSpacing, of_a_pixel_without_room_is_the_stride_of_the_edges_near_it) {
    const LookSpacing spacing(0.1, 0.5);
    const std::vector<std::pair<float, std::uint32_t>> strides{
        {1.0F, 1}, {0.6F, 1}, {0.5F, 2}, {0.3F, 3}, {0.25F, 4}, {0.1F, 4}, {0.0F, 4}};
    for (const auto& [normal_share, stride] : strides) {
        EXPECT_EQ(spacing.looks_without_event(pixel_near_edges(normal_share, 0.4F), {1, 1}, 0, 9),
                  stride)
            << normal_share;
    }
}

TEST(LookSpacing, of_a_pixel_far_from_all_edges_is_the_greatest) {
    const LookSpacing spacing(0.1, 0.5);
    EXPECT_EQ(spacing.looks_without_event(pixel_near_edges(1, 0.4F), {1e9F, 0}, 0.1F, far_sigmas),
              LookPlan::greatest_skip);
}

TEST(LookSpacing, of_a_pixel_near_edges_never_uses_up_its_room) {
    const LookSpacing spacing(0.1, 0.5);
    const double way_sigmas = 0.2;
    int more_than_one = 0;
    for (const std::uint32_t count : {1U, 3U}) {
        for (const float contrast : {0.1F, 0.4F}) {
            for (const float room : {0.001F, 0.01F, 0.05F}) {
                for (float nearest = 0; nearest < 3.5F; nearest += 0.1F) {
                    const auto looks = spacing.looks_without_event(
                        pixel_near_edges(1, contrast), {nearest, count}, room, far_sigmas);
                    if (looks == 1) continue;  // the least
                    ++more_than_one;
                    const double all_edges = count * static_cast<double>(contrast);
                    const double change = all_edges * (tail_share(nearest - looks * way_sigmas) -
                                                       tail_share(nearest));
                    EXPECT_LE(change, room + 1e-3 * all_edges)  // of the tables
                        << count << " " << contrast << " " << room << " " << nearest;
                }
            }
        }
    }
    EXPECT_GT(more_than_one, 100);
}

TEST(LookSpacing, heeds_edges_that_the_pixel_does_not_know) {
    const LookSpacing spacing(0.1, 0.5);
    const auto looks_at = [&](float unknown_sigmas) {
        return spacing.looks_without_event(pixel_near_edges(1, 0.4F), {1e9F, 0}, 0.05F,
                                           unknown_sigmas);
    };
    // tail(1.64) = 0.05 = room, of full contrast: 0.2 sigma a look from 3.64 to there are 10 looks.
    EXPECT_NEAR(looks_at(3.65F), 10, 1);
    EXPECT_EQ(looks_at(1.65F), 1U);
}

}  // namespace
}  // namespace pursuit::sensor
