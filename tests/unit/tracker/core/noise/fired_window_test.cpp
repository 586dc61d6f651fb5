// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/fired_window.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

namespace pursuit::tracker {
namespace {

constexpr int window_reach_px = 20;

class FiredSlices : public testing::Test {
 protected:
    FiredSlices() { window_.place({100, 80}, window_reach_px); }

    /// Four far corners, so that what lies between them is where events come from.
    void fire_at_the_rim() {
        for (const int x : {-30, 30}) {
            for (const int y : {-30, 30}) fire(100 + x, 80 + y);
        }
    }
    void fire(int x, int y) {
        window_.see(static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), 1);
    }
    /// Of slice i, at this pixel of the image.
    float at(std::size_t i, int x, int y) const {
        return window_.slice(i).at(static_cast<std::size_t>(y - window_.top()) * window_.side() +
                                   static_cast<std::size_t>(x - window_.left()));
    }

    FiredWindow window_;
};

TEST_F(FiredSlices, an_event_counts_for_its_pixel_and_less_for_those_beside_it) {
    fire_at_the_rim();
    fire(103, 79);
    window_.close_slice();
    EXPECT_FLOAT_EQ(at(0, 103, 79), 4.0F / 16);
    EXPECT_FLOAT_EQ(at(0, 102, 79), 2.0F / 16);
    EXPECT_FLOAT_EQ(at(0, 104, 80), 1.0F / 16);
    EXPECT_FLOAT_EQ(at(0, 105, 79), 0);
}

TEST_F(FiredSlices, what_is_forgotten_does_not_count) {
    fire_at_the_rim();
    fire(103, 79);
    window_.forget(103, 79, 1);
    window_.forget(103, 79, 1);  // it was one
    window_.close_slice();
    EXPECT_FLOAT_EQ(at(0, 103, 79), 0);
}

TEST_F(FiredSlices, the_newest_slice_is_the_first_and_the_oldest_goes) {
    fire_at_the_rim();
    fire(103, 79);
    for (std::size_t i = 0; i < FiredWindow::slices; ++i) {
        window_.close_slice();
        EXPECT_GT(at(i, 103, 79), 0) << i;
    }
    window_.close_slice();
    for (std::size_t i = 0; i < FiredWindow::slices; ++i) EXPECT_EQ(at(i, 103, 79), 0) << i;
}

TEST_F(FiredSlices, follows_the_object_and_keeps_what_fired_where_it_fired) {
    fire_at_the_rim();
    fire(103, 79);
    window_.close_slice();
    const int left = window_.left();
    window_.place({104, 80}, window_reach_px);
    EXPECT_EQ(window_.left(), left) << "it need not move with each step";
    window_.place({120, 70}, window_reach_px);
    EXPECT_EQ(window_.left(), left + 20);
    EXPECT_FLOAT_EQ(at(0, 103, 79), 4.0F / 16);
    window_.place({200, 70}, window_reach_px);
    window_.place({100, 80}, window_reach_px);
    EXPECT_EQ(at(0, 103, 79), 0) << "it was out of sight meanwhile";
}

TEST_F(FiredSlices, beyond_where_events_come_from_as_many_are_counted_as_elsewhere) {
    // The image ends at column 90: its first pixels fire like all others.
    for (int y = 45; y <= 115; ++y) {
        for (int x = 90; x <= 136; ++x) fire(x, y);
    }
    window_.close_slice();
    EXPECT_EQ(window_.seen().left, 90);
    EXPECT_NEAR(at(0, 80, 80), 1, 0.05);
    EXPECT_NEAR(at(0, 90, 80), 1, 0.05);
}

TEST_F(FiredSlices, knows_nothing_after_a_restart) {
    fire_at_the_rim();
    fire(103, 79);
    window_.close_slice();
    window_.restart();
    EXPECT_EQ(window_.side(), 0U);
    fire(103, 79);  // nobody asked for it
    window_.close_slice();
    window_.place({100, 80}, window_reach_px);
    for (std::size_t i = 0; i < FiredWindow::slices; ++i) EXPECT_EQ(at(i, 103, 79), 0) << i;
    EXPECT_FALSE(window_.seen().is_inside(103, 79));
}

}  // namespace
}  // namespace pursuit::tracker
