// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/look_plan.hpp"

#include <gtest/gtest.h>

namespace pursuit::sensor {
namespace {

/// Active pixels with these indexes.
std::vector<ActivePixels::Pixel> active_at(const std::vector<std::uint32_t>& indexes) {
    std::vector<ActivePixels::Pixel> pixels;
    for (const auto index : indexes) pixels.push_back({index, 0, 0, 0, 0, 1, 1});
    return pixels;
}

using Numbers = std::vector<std::uint32_t>;

TEST(LookPlan, lets_a_new_pixel_take_part_in_the_next_look) {
    LookPlan plan(10);
    plan.restart(active_at({7, 3}));
    EXPECT_EQ(plan.begin_look(), (Numbers{0, 1}));
    EXPECT_EQ(plan.begin_look(), Numbers{});
}

TEST(LookPlan, lets_a_pixel_look_again_after_as_many_looks_as_were_planned) {
    for (const std::uint32_t looks : {1U, 2U, LookPlan::greatest_skip}) {
        LookPlan plan(10);
        plan.restart(active_at({7}));
        plan.begin_look();
        plan.after_look(0, 7, looks);
        for (std::uint32_t i = 1; i < looks; ++i) EXPECT_EQ(plan.begin_look(), Numbers{}) << i;
        EXPECT_EQ(plan.begin_look(), Numbers{0});
    }
}

TEST(LookPlan, keeps_what_was_planned_when_the_active_pixels_are_found_anew) {
    LookPlan plan(10);
    plan.restart(active_at({7}));
    plan.begin_look();
    plan.after_look(0, 7, 3);
    plan.restart(active_at({3, 7}));
    EXPECT_EQ(plan.begin_look(), Numbers{0});
    EXPECT_EQ(plan.begin_look(), Numbers{});
    EXPECT_EQ(plan.begin_look(), Numbers{1});
}

TEST(LookPlan, keeps_nothing_for_a_pixel_that_only_was_postponed) {
    LookPlan plan(10);
    plan.restart(active_at({7}));
    plan.begin_look();
    plan.postpone(0, 2);
    EXPECT_EQ(plan.begin_look(), Numbers{});
    EXPECT_EQ(plan.begin_look(), Numbers{0});
    plan.postpone(0, 2);
    plan.restart(active_at({7}));
    EXPECT_EQ(plan.begin_look(), Numbers{0});
}

TEST(LookPlan, forgets_what_was_planned_when_every_pixel_has_looked) {
    LookPlan plan(10);
    plan.restart(active_at({7}));
    plan.begin_look();
    plan.after_look(0, 7, 9);
    plan.forget();
    plan.restart(active_at({7}));
    EXPECT_EQ(plan.begin_look(), Numbers{0});
}

}  // namespace
}  // namespace pursuit::sensor
