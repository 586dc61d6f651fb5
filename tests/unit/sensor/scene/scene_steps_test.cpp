// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/scene_steps.hpp"

#include <gtest/gtest.h>

namespace pursuit::sensor {
namespace {

/// Squares of 10 px in an image of 64 x 32: each text is what a layer has beside its square.
DrawnScene squares(const std::vector<std::string>& layers) {
    std::string text = "name: \"squares\" sensor { width: 64 height: 32 max_step_px: 0.1 }";
    for (const auto& layer : layers) {
        text += " layer { polygon { xy_px: [-5, -5, 5, -5, 5, 5, -5, 5] } " + layer + " }";
    }
    auto scene = parse_scene(text, "test");
    if (!scene) throw std::runtime_error(scene.error().message);
    return draw_scene(*scene, 1);
}

TEST(SceneSteps, place_every_layer_where_its_trajectory_says) {
    const auto scene = squares({"trajectory { x_px: 20 y_px: 16 vx_px_s: 300 omega_rad_s: 9 }"});
    SceneSteps steps(scene);
    for (int i = 0; i < 100; ++i) {
        const auto before = steps.layers()[0].now;
        steps.advance(scene);
        EXPECT_TRUE(steps.layers()[0].before == before);
        EXPECT_TRUE(steps.layers()[0].now == place_of(scene, scene.layers[0], steps.now_us()));
    }
}

TEST(SceneSteps, are_as_long_as_the_fastest_layer_allows_but_never_too_long) {
    // In 0.1 px: 1000 us at 100 px/s, of which 1000 is the longest, and 200 us at 500 px/s.
    const auto slow = squares({"trajectory { x_px: 9 y_px: 16 vx_px_s: 10 }"});
    const auto both = squares({"trajectory { x_px: 9 y_px: 16 vx_px_s: 10 }",
                               "trajectory { x_px: 9 y_px: 16 vx_px_s: 500 }"});
    SceneSteps slow_steps(slow);
    SceneSteps both_steps(both);
    for (int i = 0; i < 100; ++i) {
        slow_steps.advance(slow);
        both_steps.advance(both);
        EXPECT_LE(slow_steps.step_us(), 1000);
        EXPECT_LE(both_steps.layers()[1].step_px, 0.105);
    }
    EXPECT_EQ(slow_steps.step_us(), 1000);
    EXPECT_NEAR(static_cast<double>(both_steps.step_us()), 205, 6);
}

TEST(SceneSteps, end_where_a_layer_comes_or_goes) {
    const auto scene = squares({"from_s: 0.0101 trajectory { x_px: 9 y_px: 16 vx_px_s: 10 }",
                                "to_s: 0.0203 trajectory { x_px: 30 y_px: 16 }"});
    SceneSteps steps(scene);
    std::vector<std::int64_t> changes_us;
    while (steps.now_us() < 30'000) {
        steps.advance(scene);
        if (steps.comes_or_goes()) changes_us.push_back(steps.now_us());
        EXPECT_LE(steps.layers()[0].step_px, 0.105);  // coming is no motion
    }
    EXPECT_EQ(changes_us, (std::vector<std::int64_t>{10'100, 20'300}));
}

TEST(SceneSteps, tell_layers_that_never_move_from_the_others) {
    const auto scene =
        squares({"trajectory { x_px: 9 }", "trajectory { vx_px_s: 1 }", "from_s: 1"});
    const SceneSteps steps(scene);
    EXPECT_TRUE(steps.layers()[0].fixed);
    EXPECT_FALSE(steps.layers()[1].fixed);
    EXPECT_FALSE(steps.layers()[2].fixed);
}

TEST(SceneSteps, measure_how_far_what_is_in_the_image_moves) {
    const auto scene = squares({"trajectory { x_px: 9 vx_px_s: 1 }"});
    const SceneSteps steps(scene);
    const auto& layer = steps.layers()[0];
    PlanarMap moved = layer.now;
    moved.matrix(0, 2) += 3;
    moved.matrix(1, 2) += 4;
    EXPECT_NEAR(steps.displacement_px(layer, layer.now, moved), 5, 1e-9);
    EXPECT_EQ(steps.displacement_px(layer, moved, moved), 0);
}

}  // namespace
}  // namespace pursuit::sensor
