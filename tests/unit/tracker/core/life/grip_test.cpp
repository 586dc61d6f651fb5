// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/grip.hpp"

#include <gtest/gtest.h>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

constexpr double let_go = 0.33;

/// 10,000 events a second until then, every `sharp_of`-th of them on the contour.
void hold_grip(Grip& grip, std::int64_t from_us, std::int64_t until_us, int sharp_of,
               bool is_seen = false) {
    for (std::int64_t t_us = from_us, i = 0; t_us < until_us; t_us += 100, ++i) {
        grip.count(i % sharp_of == 0);
        if (grip.is_due()) grip.weigh(t_us, false, is_seen, let_go);
    }
}

TEST(Grip, is_lost_when_events_have_spoken_against_the_pose_for_60_ms) {
    Grip grip{Contour(test::arrow())};
    hold_grip(grip, 0, 200'000, 1);
    EXPECT_FALSE(grip.is_against());
    EXPECT_GT(grip.fit(), 0.9);
    std::int64_t against_us = -1;
    std::int64_t lost_us = -1;
    for (std::int64_t t_us = 200'000; t_us < 400'000 && lost_us < 0; t_us += 1000) {
        hold_grip(grip, t_us, t_us + 1000, 5);
        if (against_us < 0 && grip.is_against()) against_us = t_us;
        if (grip.is_lost()) lost_us = t_us;
    }
    EXPECT_NEAR(static_cast<double>(lost_us - against_us), 60'000, 2000);
    EXPECT_LT(grip.fit(), 0.3);
}

TEST(Grip, looks_where_events_come_from_when_enough_came_and_every_2_ms_at_most) {
    const Contour contour(test::arrow());
    const Outline outline(contour);
    Grip grip(contour);
    const auto count_places = [&] {
        for (int i = 0; i < 100; ++i) grip.count_place(0);
    };
    EXPECT_FALSE(grip.is_due_to_look(10'000));
    count_places();
    ASSERT_TRUE(grip.is_due_to_look(10'000));
    grip.look_around(10'000, outline, {}, {1000, 0, 0, 0, 0});
    EXPECT_FALSE(grip.is_due_to_look(13'000));
    count_places();
    EXPECT_FALSE(grip.is_due_to_look(11'999));
    EXPECT_TRUE(grip.is_due_to_look(12'000));
}

TEST(Grip, is_patchy_where_too_little_of_the_contour_made_events_for_a_tenth_of_a_second) {
    const Contour contour(test::arrow());
    const Outline outline(contour);
    Grip grip(contour);
    const Velocity right{1000, 0, 0, 0, 0};
    int times = 0;
    for (std::int64_t t_us = 10'000; t_us < 360'000; t_us += 5'000) {
        for (int i = 0; i < 100; ++i) grip.count_place(0);
        grip.look_around(t_us, outline, {}, right);
        times += grip.is_patchy(t_us) ? 1 : 0;
    }
    EXPECT_EQ(times, 3);
}

TEST(Grip, is_not_patchy_where_all_of_the_contour_makes_events) {
    const Contour contour(test::arrow());
    const Outline outline(contour);
    Grip grip(contour);
    const auto& pieces = contour.pieces().pieces();
    for (std::int64_t t_us = 10'000; t_us < 360'000; t_us += 5'000) {
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const double across_px = std::abs(pieces[i].by - pieces[i].ay);
            for (int k = 0; k < std::lround(3 * across_px); ++k) {
                grip.count_place(static_cast<std::int32_t>(i));
            }
        }
        grip.look_around(t_us, outline, {}, {1000, 0, 0, 0, 0});
        EXPECT_FALSE(grip.is_patchy(t_us)) << t_us;
    }
}

TEST(Grip, is_not_lost_while_the_object_is_seen_among_noise) {
    Grip grip{Contour(test::arrow())};
    hold_grip(grip, 0, 200'000, 1);
    hold_grip(grip, 200'000, 500'000, 5, true);
    EXPECT_FALSE(grip.is_against());
    EXPECT_LT(grip.fit(), 0.3);
    hold_grip(grip, 500'000, 600'000, 5);
    EXPECT_TRUE(grip.is_lost());
}

TEST(Grip, forgives_when_it_is_told_to) {
    Grip grip{Contour(test::arrow())};
    hold_grip(grip, 0, 300'000, 5);
    ASSERT_TRUE(grip.is_lost());
    grip.forgive();
    EXPECT_FALSE(grip.is_against());
}

TEST(Grip, waits_for_some_events_before_it_weighs_them) {
    Grip grip{Contour(test::arrow())};
    EXPECT_FALSE(grip.is_counting());
    grip.count(true);
    EXPECT_TRUE(grip.is_counting());
    EXPECT_FALSE(grip.is_due());
    for (int i = 0; i < Grip::together - 1; ++i) grip.count(i % 2 == 0);
    EXPECT_TRUE(grip.is_due());
    EXPECT_EQ(grip.sharp(), Grip::together / 2 + 1);
    EXPECT_EQ(grip.astray(), Grip::together / 2 - 1);
    grip.weigh(0, false, false, let_go);
    EXPECT_FALSE(grip.is_counting());
}

}  // namespace
}  // namespace pursuit::tracker
