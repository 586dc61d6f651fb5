// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/leads/pixel_levels.hpp"

#include <gtest/gtest.h>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

constexpr std::int64_t apart_us = 10'000;
constexpr double grain_px = 0.01;

/// The events of one pixel of a square of 40 px.
class OnePixel : public testing::Test {
 protected:
    OnePixel() : contour_(test::square()), levels_(contour_) {
        levels_.set_blind_us(0);
        levels_.restart();
    }

    /// What the level of the next event tells, which comes with the pixel at this place.
    PixelLevels::Told fire(bool is_on, double place_px, double speed_px_s = 0,
                           std::int32_t piece = 0) {
        const Event event{t_us_ += apart_us, x_, 100, static_cast<std::uint8_t>(is_on ? 1 : 0)};
        const auto told = levels_.cross(event, apart_us, piece);
        levels_.learn(place_px, speed_px_s, true);
        return told;
    }

    Contour contour_;
    PixelLevels levels_;
    std::int64_t t_us_ = 0;
    std::uint16_t x_ = 100;
};

TEST_F(OnePixel, knows_no_level_that_it_has_not_crossed) {
    EXPECT_FALSE(fire(true, 0.5).is_known);
    EXPECT_FALSE(fire(true, 0.2).is_known);
    EXPECT_FALSE(fire(true, -0.3).is_known);
}

TEST_F(OnePixel, crosses_the_same_levels_where_it_did_as_the_edge_comes_back) {
    fire(true, 0.5);
    fire(true, 0.2);
    fire(true, -0.3);
    const auto first = fire(false, 0.2);
    EXPECT_TRUE(first.is_known);
    EXPECT_NEAR(first.place_px, 0.2, grain_px);
    EXPECT_NEAR(fire(false, 0.5).place_px, 0.5, grain_px);
    EXPECT_FALSE(fire(false, 0.9).is_known);
    EXPECT_NEAR(fire(true, 0.5).place_px, 0.5, grain_px);
}

TEST_F(OnePixel, forgets_a_pixel_that_fired_for_something_else) {
    fire(true, 0.5);
    fire(true, 0.2);
    t_us_ += apart_us;  // another's event, apart_us before the next
    EXPECT_FALSE(fire(false, 0.5).is_known);
}

TEST_F(OnePixel, tells_pixels_apart_that_share_a_place) {
    fire(true, 0.5);
    fire(true, 0.2);
    x_ += 64;
    EXPECT_FALSE(fire(false, 0.5).is_known);
    x_ -= 64;
    t_us_ -= apart_us;
    EXPECT_FALSE(fire(false, 0.5).is_known);
}

TEST_F(OnePixel, forgets_what_another_edge_did) {
    const auto other = static_cast<std::int32_t>(contour_.pieces().pieces().size()) - 1;
    fire(true, 0.5);
    fire(true, 0.2);
    EXPECT_FALSE(fire(false, 0.5, 0, other).is_known);
}

TEST_F(OnePixel, forgets_all_when_the_pose_is_put_elsewhere) {
    fire(true, 0.5);
    fire(true, 0.2);
    levels_.restart();
    EXPECT_FALSE(fire(false, 0.5).is_known);
}

TEST_F(OnePixel, forgets_for_good_however_often_the_pose_is_put_elsewhere) {
    fire(true, 0.5);
    fire(true, 0.2);
    for (int i = 0; i < 65'536; ++i) levels_.restart();
    EXPECT_FALSE(fire(false, 0.5).is_known);
}

TEST_F(OnePixel, a_level_moves_as_the_edge_goes_while_the_pixel_is_blind) {
    levels_.set_blind_us(500);
    fire(true, 0.5, 100);
    fire(true, 0.2, 100);
    const double told_px = fire(false, 0.5, -100).place_px;
    EXPECT_LT(told_px, 0.5 - 0.05);
    EXPECT_GT(told_px, 0.5 - 0.1 - grain_px);
}

TEST_F(OnePixel, says_nothing_of_an_edge_that_is_gone_before_the_pixel_sees_again) {
    levels_.set_blind_us(1000);
    EXPECT_TRUE(levels_.tell_at(100));
    EXPECT_FALSE(levels_.tell_at(1000));
}

TEST_F(OnePixel, takes_a_long_blindness_for_rare_events) {
    levels_.set_blind_us(1000);
    fire(true, 0.5, 100);
    const double usual_px = fire(false, 0.5, -100).place_px;
    levels_.set_blind_us(10'000);
    levels_.restart();
    fire(true, 0.5, 100);
    EXPECT_NEAR(fire(false, 0.5, -100).place_px, usual_px, grain_px);
}

TEST_F(OnePixel, tells_an_object_that_turns_back_and_forth_from_one_that_goes_on) {
    for (int i = 0; i < 300; ++i) {
        x_ = i / 3 % 2 == 0 ? 100 : 101;
        fire(true, 0.5 - 0.3 * (i % 3));
    }
    EXPECT_EQ(levels_.crossed_again(), 0);
    for (int i = 0; i < 300; ++i) fire(i % 2 == 0, 0.5);
    EXPECT_GT(levels_.crossed_again(), 0.8);
    levels_.restart();
    EXPECT_EQ(levels_.crossed_again(), 0);
}

TEST_F(OnePixel, is_trusted_less_where_it_does_not_fit) {
    const double before = levels_.check(0.1, 0.05);
    for (int i = 0; i < 300; ++i) levels_.check(i % 2 == 0 ? 0.9 : -0.7, 0.05);
    EXPECT_LT(levels_.check(0.1, 0.05), 0.5);
    for (int i = 0; i < 600; ++i) levels_.check(0.1, 0.05);
    EXPECT_GT(levels_.check(0.1, 0.05), before);
    EXPECT_LT(levels_.check(3, 0.05), 0.5);
}

}  // namespace
}  // namespace pursuit::tracker
