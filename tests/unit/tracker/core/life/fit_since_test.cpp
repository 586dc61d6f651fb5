// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/fit_since.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

FitSince after(int sharp, int astray, double usual_share) {
    FitSince fit;
    fit.count(sharp, astray, usual_share);
    return fit;
}

TEST(FitSince, speaks_against_what_fits_much_less_often_than_usual) {
    EXPECT_TRUE(after(30, 70, 0.9).is_against());
    EXPECT_TRUE(after(50, 50, 0.9).is_against());
    EXPECT_FALSE(after(50, 50, 0.9).is_as_usual());
}

TEST(FitSince, is_as_usual_where_three_of_four_fit_that_usually_do) {
    EXPECT_TRUE(after(85, 15, 0.9).is_as_usual());
    EXPECT_TRUE(after(70, 30, 0.9).is_as_usual());
    EXPECT_FALSE(after(70, 30, 0.9).is_against());
    EXPECT_TRUE(after(40, 60, 0.5).is_as_usual());
}

TEST(FitSince, tells_nothing_of_few_events_that_chance_may_explain) {
    EXPECT_FALSE(after(2, 3, 0.9).is_against());
    EXPECT_FALSE(after(2, 3, 0.9).is_as_usual());
    EXPECT_FALSE(FitSince().is_against());
}

TEST(FitSince, takes_nothing_from_events_of_which_no_share_is_usual) {
    FitSince fit;
    for (int i = 0; i < 100; ++i) fit.count(0, 10, 0);
    EXPECT_FALSE(fit.is_against());
    EXPECT_TRUE(fit.is_as_usual());
}

TEST(FitSince, begins_anew_when_restarted) {
    FitSince fit = after(30, 70, 0.9);
    fit.restart();
    EXPECT_FALSE(fit.is_against());
    EXPECT_TRUE(fit.is_as_usual());
}

}  // namespace
}  // namespace pursuit::tracker
