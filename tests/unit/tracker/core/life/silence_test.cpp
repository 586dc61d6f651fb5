// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/silence.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

constexpr double usual_hz = 20'000;

TEST(Silence, begins_once_when_thirty_events_have_not_come_for_3_ms) {
    Silence silence;
    silence.hear(1'000'000);
    EXPECT_FALSE(silence.begins(1'001'000, usual_hz, 0));
    EXPECT_FALSE(silence.begins(1'002'900, usual_hz, 0));
    EXPECT_TRUE(silence.begins(1'003'000, usual_hz, 0));
    EXPECT_FALSE(silence.begins(1'010'000, usual_hz, 0));
    silence.hear(1'020'000);
    EXPECT_TRUE(silence.begins(1'030'000, usual_hz, 0));
}

TEST(Silence, begins_sooner_where_the_object_may_have_gone_on) {
    Silence silence;
    silence.hear(0);
    EXPECT_TRUE(silence.begins(1'600, usual_hz, 2000));
    silence.hear(10'000);
    EXPECT_FALSE(silence.begins(11'600, usual_hz, 1000));
}

TEST(Silence, is_none_of_what_makes_few_events_or_was_never_heard) {
    Silence silence;
    EXPECT_FALSE(silence.is_silent(1'000'000'000, usual_hz));
    silence.hear(0);
    EXPECT_FALSE(silence.begins(1'000'000, 10, 0));
    silence.restart();
    EXPECT_FALSE(silence.is_silent(1'000'000'000, usual_hz));
}

TEST(Silence, tells_of_a_pause_of_more_than_half_a_ms) {
    Silence silence;
    EXPECT_TRUE(silence.hear(10'000));
    EXPECT_FALSE(silence.hear(10'500));
    EXPECT_TRUE(silence.hear(11'001));
}

}  // namespace
}  // namespace pursuit::tracker
