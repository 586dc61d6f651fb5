// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "services/sensor/scene/scene_simulator.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pursuit::sensor {
namespace {

using testing::Contains;
using testing::HasSubstr;

std::string error_of(const std::string& text) {
    const auto scene = parse_scene(text, "s.textproto");
    return scene ? "no error" : scene.error().message;
}

const std::string layer_of = "name: \"s\" layer { ";
const std::string square = "polygon { xy_px: [0, 0, 10, 0, 10, 10, 0, 10] } ";

TEST(LoadScene, knows_each_built_in_scene_under_its_own_name) {
    const auto names = list_builtin_scenes();
    EXPECT_THAT(names, Contains("overtake"));
    EXPECT_THAT(names, Contains("star_670rpm"));
    for (const auto& name : names) {
        const auto scene = load_scene(name);
        ASSERT_TRUE(scene) << scene.error().message;
        EXPECT_EQ(scene->description().name(), name);
    }
}

TEST(LoadScene, gives_every_tracked_shape_of_a_built_in_scene_between_58_and_110_points) {
    for (const auto& name : list_builtin_scenes()) {
        const SceneSimulator simulator(*load_scene(name), 1);
        ASSERT_FALSE(simulator.models().empty()) << name;
        for (const auto& model : simulator.models()) {
            EXPECT_GE(model.model.points.size(), 58U) << name;
            EXPECT_LE(model.model.points.size(), 110U) << name;
            EXPECT_EQ(model.model.edges.size(), model.model.points.size()) << name;
        }
    }
}

TEST(LoadScene, names_the_built_in_scenes_where_it_finds_nothing) {
    const auto scene = load_scene("no_such_scene");
    ASSERT_FALSE(scene);
    EXPECT_THAT(scene.error().message, HasSubstr("no_such_scene"));
    EXPECT_THAT(scene.error().message, HasSubstr("star_1250rpm"));
}

TEST(LoadScene, reads_a_file) {
    const test::TemporaryFolder folder;
    const auto scene =
        load_scene(folder.file("mine.scene.textproto", "name: \"mine\" duration_s: 1"));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->description().name(), "mine");
}

TEST(LoadScene, gives_an_isometry_truth_of_scale_1_and_the_drawn_size_in_its_model) {
    for (const auto& name : list_builtin_scenes()) {
        const auto scene = *load_scene(name);
        for (const std::uint64_t seed : {1, 2, 3}) {
            const SceneSimulator simulator(scene, seed);
            for (const auto& model : simulator.models()) {
                if (model.transform != disk::SceneLayer::ISOMETRY) continue;
                EXPECT_NEAR(model.start.scale_x, 1, 1e-9) << name;
                EXPECT_NEAR(model.start.scale_y, 1, 1e-9) << name;
            }
        }
    }
    const auto radius_px = [](std::uint64_t seed) {
        const SceneSimulator simulator(*load_scene("star_670rpm"), seed);
        double radius = 0;
        for (const Point& p : simulator.models()[0].model.points) {
            radius = std::max(radius, p.norm());
        }
        return radius;
    };
    EXPECT_NEAR(radius_px(1), 27, 0.15 * 27 + 1e-6);
    EXPECT_GT(std::abs(radius_px(1) - radius_px(2)), 1e-3);
}

TEST(LoadScene, leaves_to_the_pose_the_scale_that_it_has_to_find) {
    const auto scale = [](std::uint64_t seed) {
        return SceneSimulator(*load_scene("appear"), seed).truth(0)[0].scale_x;
    };
    EXPECT_GT(std::abs(scale(1) - scale(2)), 1e-3);
}

TEST(LoadScene, applies_settings_over_what_the_scene_states) {
    const auto scene =
        load_scene("star_670rpm", {"sensor.threshold=0.5", "layer[0].trajectory.disc.rpm=900",
                                   "layer[0].variation.speed_share=0", "sensor.refractory_us=1"});
    ASSERT_TRUE(scene) << scene.error().message;
    for (const std::uint64_t seed : {1, 2}) {
        const SceneSimulator simulator(*scene, seed);
        EXPECT_EQ(simulator.drawn().sensor.threshold(), 0.5);
        EXPECT_EQ(simulator.drawn().sensor.refractory_us(), 1U);
        const auto turn = simulator.truth(1000)[0].theta_rad - simulator.truth(0)[0].theta_rad;
        EXPECT_NEAR(std::abs(std::remainder(turn, 2 * M_PI)), 2 * M_PI * 900 / 60 / 1000, 1e-6);
    }
    EXPECT_NE(SceneSimulator(*scene, 1).drawn().sensor.mismatch(),
              SceneSimulator(*scene, 2).drawn().sensor.mismatch());
}

TEST(LoadScene, says_which_setting_is_wrong_and_what_makes_the_scene_impossible) {
    const auto wrong = load_scene("star_670rpm", {"sensor.threshold=9"});
    ASSERT_FALSE(wrong);
    EXPECT_THAT(wrong.error().message, HasSubstr("sensor.threshold=9"));
    EXPECT_THAT(wrong.error().message, HasSubstr("at most 3"));
    const auto layer = load_scene("star_670rpm", {"layer[1].to_s=1"});
    ASSERT_FALSE(layer);
    EXPECT_THAT(layer.error().message, HasSubstr("there are 1 of field"));
    const auto never = load_scene("star_670rpm", {"layer[0].to_s=0"});
    ASSERT_FALSE(never);
    EXPECT_THAT(never.error().message, HasSubstr("to_s"));
}

TEST(ParseScene, names_file_and_line_of_an_unknown_field) {
    EXPECT_THAT(error_of("name: \"s\"\nlayers { }"), HasSubstr("s.textproto:2:"));
}

TEST(ParseScene, names_the_line_of_what_cannot_be_simulated_or_the_setting) {
    const std::string two = "name: \"s\"\nlayer { " + square + "}\nlayer { " + square;
    EXPECT_THAT(error_of(two + "\nto_s: 0 }"), HasSubstr("s.textproto:4: layer[1].to_s: "));
    EXPECT_THAT(error_of(two + "\npolygon { xy_px: [0, 0] } }"),
                HasSubstr("s.textproto:4: layer[1].polygon[1] "));
    EXPECT_THAT(error_of(two + "\ntrack: \"a/b\" }"), HasSubstr("s.textproto:4: layer[1].track: "));
    const auto set = parse_scene(two + "}", "s.textproto", {"layer[1].to_s=0"});
    ASSERT_FALSE(set);
    EXPECT_THAT(set.error().message, testing::StartsWith("--set layer[1].to_s=0: layer[1].to_s: "));
}

TEST(ParseScene, refuses_what_cannot_be_simulated_and_says_where) {
    EXPECT_THAT(error_of("name: \"a b\""), HasSubstr("name"));
    EXPECT_THAT(error_of(layer_of + "}"), HasSubstr("layer[0]"));
    EXPECT_THAT(error_of(layer_of + "polygon { xy_px: [0, 0, 1] } }"), HasSubstr("odd number"));
    EXPECT_THAT(error_of(layer_of + "polygon { xy_px: [0, 0, 9, 0] } }"), HasSubstr("2 corners"));
    EXPECT_THAT(error_of(layer_of + "polygon { xy_px: [0, 0, 9, 0, 0, 0] } }"),
                HasSubstr("layer[0].polygon[0]"));
    EXPECT_THAT(error_of(layer_of + "polygon { xy_px: [0, 0, 9, 9, 9, 0, 0, 9] } }"),
                HasSubstr("crosses itself"));
    EXPECT_THAT(error_of(layer_of + "polygon { xy_px: [0, 0, 5, 0, 9, 0] } }"),
                HasSubstr("layer[0].polygon[0]"));
    EXPECT_THAT(error_of(layer_of + "track: \"a/b\" " + square + "}"), HasSubstr("track"));
    EXPECT_THAT(error_of(layer_of + "track: \"\" " + square + "}"), HasSubstr("track"));
    EXPECT_THAT(
        error_of(layer_of + "track: \"a\" " + square + "} layer { track: \"a\" " + square + "}"),
        HasSubstr("layer[1].track"));
    EXPECT_THAT(error_of(layer_of + square + "trajectory { key { t_s: 1 } key { t_s: 1 } } }"),
                HasSubstr("key[1]"));
    EXPECT_THAT(error_of(layer_of + square +
                         "trajectory { sine { target: SCALE amplitude: 1 frequency_hz: 1 } } }"),
                HasSubstr("scale"));
    EXPECT_THAT(error_of(layer_of + square +
                         "trajectory { scale: 20 focal_px: 50 sine { target: TILT_X amplitude: 1 "
                         "frequency_hz: 1 } } }"),
                HasSubstr("focal_px"));
    EXPECT_THAT(error_of(layer_of + "clutter { count: 1 x_px { low: 2 high: 1 } y_px { low: 0 "
                                    "high: 1 } size_px { low: 9 high: 9 } } }"),
                HasSubstr("clutter"));
    EXPECT_THAT(error_of("name: \"s\" sensor { threshold: 0 }"), HasSubstr("threshold"));
    EXPECT_THAT(error_of("name: \"s\" camera { sine { target: SHEAR amplitude: 1 frequency_hz: 1 "
                         "} }"),
                HasSubstr("camera"));
}

}  // namespace
}  // namespace pursuit::sensor
