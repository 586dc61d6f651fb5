// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/layer_looks.hpp"

#include <gtest/gtest.h>

namespace pursuit::sensor {
namespace {

/// A layer at 500 px/s, one at 50 px/s, and one that rests.
DrawnScene fast_slow_and_resting() {
    const std::string square = "polygon { xy_px: [-5, -5, 5, -5, 5, 5, -5, 5] } ";
    auto scene = parse_scene(
        "name: \"squares\" sensor { width: 64 height: 32 max_step_px: 0.1 } "
        "layer { " +
            square +
            "trajectory { x_px: 5 y_px: 16 vx_px_s: 500 } } "
            "layer { " +
            square +
            "trajectory { x_px: 5 y_px: 16 vx_px_s: 50 } } "
            "layer { " +
            square + "trajectory { x_px: 40 y_px: 16 } }",
        "test");
    if (!scene) throw std::runtime_error(scene.error().message);
    return draw_scene(*scene, 1);
}

const std::vector<LayerMotion> motions{LayerMotion::moving, LayerMotion::moving,
                                       LayerMotion::fixed};

TEST(LayerLooks, look_at_each_layer_before_it_has_moved_by_more_than_a_step) {
    const auto scene = fast_slow_and_resting();
    SceneSteps steps(scene);
    while (steps.now_us() < 10'000) steps.advance(scene);  // until steps no longer grow
    LayerLooks looks(steps, 0.1);
    std::array<int, 3> counts{};
    std::array<PlanarMap, 3> seen{steps.layers()[0].now, steps.layers()[1].now,
                                  steps.layers()[2].now};
    while (steps.now_us() < 60'000) {
        steps.advance(scene);
        const auto due = looks.begin(steps, motions, false);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& layer = steps.layers()[i];
            EXPECT_EQ(looks.looked_at(i), (due >> i & 1) == 1);
            EXPECT_LE(steps.displacement_px(layer, seen[i], layer.now), 0.106);
            if (!looks.looked_at(i)) continue;
            seen[i] = layer.now;
            ++counts[i];
        }
        if (due != 0) looks.end(steps);
    }
    EXPECT_NEAR(counts[0], 250, 15);  // 25 px
    EXPECT_NEAR(counts[1], 25, 5);    // 2.5 px
    EXPECT_EQ(counts[2], 0);
}

TEST(LayerLooks, look_at_all_that_moved_where_that_is_asked_for) {
    const auto scene = fast_slow_and_resting();
    SceneSteps steps(scene);
    LayerLooks looks(steps, 0.1);
    for (int i = 0; i < 5; ++i) steps.advance(scene);
    EXPECT_EQ(looks.begin(steps, motions, true), 3U);
}

TEST(LayerLooks, tell_since_when_a_change_may_have_gone_unseen) {
    const auto scene = fast_slow_and_resting();
    SceneSteps steps(scene);
    LayerLooks looks(steps, 0.1);
    std::vector<std::int64_t> looks_us(LookSpacing::greatest_stride, 0);
    for (int i = 0; i < 20; ++i) {
        steps.advance(scene);
        // The pixel looks once in greatest_stride looks: so far back its last one may lie.
        const auto oldest = looks_us.end() - LookSpacing::greatest_stride;
        EXPECT_EQ(looks.settled_us(steps), *oldest);
        ASSERT_EQ(looks.begin(steps, motions, true), 3U);
        EXPECT_EQ(looks.since_us(1), *oldest);
        EXPECT_EQ(looks.longest_gap_us(), std::max(steps.now_us() - looks_us.back(),  //
                                                   steps.step_us()));
        looks.end(steps);
        looks_us.push_back(steps.now_us());
    }
    looks.all_looked(steps);
    EXPECT_EQ(looks.settled_us(steps), steps.now_us());
}

}  // namespace
}  // namespace pursuit::sensor
