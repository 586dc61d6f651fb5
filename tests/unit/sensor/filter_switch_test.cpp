// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filter_switch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;

TEST(FilterSwitch, gives_a_changed_chain_once_and_a_refused_change_changes_nothing) {
    auto made = FilterSwitch::make({*parse_filter("polarity keep=1")});
    ASSERT_TRUE(made);
    auto& filters = **made;
    EXPECT_EQ(filters.take(), nullptr);
    const auto first = filters.begin({20, 10});
    ASSERT_TRUE(first);
    EXPECT_EQ((*first)->geometry(), (Geometry{20, 10}));
    const auto refused = filters.set({*parse_filter("region_of_interest x_px=20")});
    EXPECT_THAT(refused.error().message, HasSubstr("x_px is 20, must be less than 20"));
    EXPECT_EQ(filters.take(), nullptr);
    EXPECT_EQ(filters.names(), "polarity");
    ASSERT_TRUE(filters.set({*parse_filter("geometry transpose=1")}));
    const auto changed = filters.take();
    ASSERT_NE(changed, nullptr);
    EXPECT_EQ(changed->geometry(), (Geometry{10, 20}));
    EXPECT_EQ(filters.take(), nullptr);
    EXPECT_EQ((*filters.begin({8, 4}))->geometry(), (Geometry{4, 8}));
}

TEST(FilterSwitch, before_the_first_stream_judges_what_needs_no_size) {
    auto filters = std::move(*FilterSwitch::make({}));
    EXPECT_FALSE(filters->set({*parse_filter("refractory period_us=0")}));
    ASSERT_TRUE(filters->set({*parse_filter("region_of_interest x_px=20")}));
    EXPECT_EQ(filters->take(), nullptr);
    EXPECT_FALSE(filters->begin({20, 10}));
    EXPECT_TRUE(filters->begin({21, 10}));
    EXPECT_FALSE(FilterSwitch::make({*parse_filter("no_such")}));
}

}  // namespace
}  // namespace pursuit::sensor
