// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/clutter.hpp"

#include <gtest/gtest.h>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

TEST(Clutter, is_near_nothing_for_an_object_alone_and_high_in_noise) {
    Contour contour{test::arrow()};
    contour.fit(Eigen::Matrix2d::Identity(), 8);
    Clutter clutter;
    clutter.restart();
    clutter.sample(contour, Eigen::Matrix2d::Identity());
    for (int i = 0; i < 3000; ++i) clutter.count_near(0, 1);
    EXPECT_LT(clutter.density(0, 1), 0.01);
    EXPECT_GT(clutter.own_share(), 0.95);
    // As many beside the contour, over 2 × 3 px, as on it, over 2 × 4: most on it is clutter too.
    for (int i = 0; i < 6000; ++i) {
        clutter.count_near(0, 0.3);
        clutter.count_far(0, i % 2 == 0 ? 5 : -5);
    }
    EXPECT_GT(clutter.density(0, 1), 0.2);
    EXPECT_LT(clutter.own_share(), 0.3);
}

}  // namespace
}  // namespace pursuit::tracker
