// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/write_simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "services/sensor/scene/scene_simulator.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

Scene parsed(const std::string& text) {
    auto scene = parse_scene(text, "test");
    if (!scene) throw std::runtime_error(scene.error().message);
    return *scene;
}

class WriteSimulation : public testing::Test {
 protected:
    std::string path(const std::string& name) const { return folder_.path(name); }

    std::vector<std::string> lines(const std::string& name) const {
        std::ifstream in(path(name));
        std::vector<std::string> all;
        for (std::string line; std::getline(in, line);) all.push_back(line);
        return all;
    }

    test::TemporaryFolder folder_;
};

const std::string moving_star =
    "name: \"s\" duration_s: 0.05 model_noise_px: 0.5 layer { track: \"star\" shape { kind: STAR "
    "size_px: 20 } trajectory { x_px: 100 y_px: 90 vx_px_s: 40 omega_rad_s: 2 } }";

TEST_F(WriteSimulation, writes_truth_every_millisecond_and_all_events_in_order) {
    std::vector<Event> events;
    const auto take = [&](std::span<const Event> slice, std::span<const Event>) -> Result<void> {
        events.insert(events.end(), slice.begin(), slice.end());
        return {};
    };
    SimulationFiles files;
    files.truth_path = path("truth.csv");
    files.models_dir = path("models");
    const auto summary = write_simulation(parsed(moving_star), 3, take, files);
    ASSERT_TRUE(summary) << summary.error().message;
    EXPECT_EQ(summary->events, events.size());
    EXPECT_EQ(summary->duration_us, 50000);
    EXPECT_GT(events.size(), 100U);

    const auto truth = lines("truth.csv");
    ASSERT_EQ(truth.size(), 52U);
    EXPECT_EQ(truth[0],
              "t_us,object_id,model,x_px,y_px,a00,a01,a10,a11,theta_rad,scale_x,scale_y,"
              "visible_fraction,fit_px");
    EXPECT_THAT(truth[1], StartsWith("0,1,star,100.000000,90.000000,1.000000000,"));
    // 0.05 s later: 2 px to the right, turned by 0.1 rad.
    EXPECT_THAT(truth[51], StartsWith("50000,1,star,102.000000,90.000000,0.995004165,-0.099833417,"
                                      "0.099833417,0.995004165,0.10000000,1.00000000,"));
    EXPECT_THAT(lines("models/model_star.csv")[0], "x_px,y_px");
    EXPECT_THAT(lines("models/model_star_edges.csv")[0], "from,to");
    EXPECT_EQ(lines("models/model_star.csv").size(), lines("models/model_true_star.csv").size());
    EXPECT_NE(lines("models/model_star.csv"), lines("models/model_true_star.csv"));
    EXPECT_THAT(lines("models/start.csv")[1], HasSubstr(",pose,"));
}

TEST_F(WriteSimulation, refuses_an_endless_scene_without_a_duration) {
    SimulationFiles files;
    files.truth_path = path("truth.csv");
    const auto none = [](std::span<const Event>, std::span<const Event>) -> Result<void> {
        return {};
    };
    const auto summary = write_simulation(parsed("name: \"endless\""), 1, none, files);
    ASSERT_FALSE(summary);
    EXPECT_THAT(summary.error().message, HasSubstr("endless"));
    files.duration_s = 0.01;
    EXPECT_TRUE(write_simulation(parsed("name: \"endless\""), 1, none, files));
}

TEST_F(WriteSimulation, reports_a_folder_it_cannot_write_to_and_an_error_of_the_sink) {
    SimulationFiles files;
    files.truth_path = path("no/such/folder/truth.csv");
    const auto none = [](std::span<const Event>, std::span<const Event>) -> Result<void> {
        return {};
    };
    auto summary = write_simulation(parsed(moving_star), 1, none, files);
    ASSERT_FALSE(summary);
    EXPECT_THAT(summary.error().message, HasSubstr("truth.csv"));
    files.truth_path = path("truth.csv");
    const auto full = [](std::span<const Event>, std::span<const Event>) -> Result<void> {
        return fail("disk full");
    };
    summary = write_simulation(parsed(moving_star), 1, full, files);
    ASSERT_FALSE(summary);
    EXPECT_EQ(summary.error().message, "disk full");
}

TEST_F(WriteSimulation, writes_no_model_over_the_truth_or_what_is_to_be_kept) {
    SimulationFiles files;
    files.truth_path = path("start.csv");
    files.models_dir = path("");
    const auto none = [](std::span<const Event>, std::span<const Event>) -> Result<void> {
        return {};
    };
    auto summary = write_simulation(parsed(moving_star), 1, none, files);
    ASSERT_FALSE(summary);
    EXPECT_THAT(summary.error().message, HasSubstr("start.csv: is also the output"));
    files.truth_path = path("truth.csv");
    files.kept_paths = {path("model_star.csv")};
    std::ofstream(path("model_star.csv")) << "events";
    std::ofstream(path("truth.csv")) << "of an earlier run";
    summary = write_simulation(parsed(moving_star), 1, none, files);
    ASSERT_FALSE(summary);
    EXPECT_EQ(lines("model_star.csv"), std::vector<std::string>{"events"});
    EXPECT_EQ(lines("truth.csv"), std::vector<std::string>{"of an earlier run"});
    EXPECT_FALSE(std::filesystem::exists(path("model_star_edges.csv")));
}

TEST(Truth, refers_to_the_time_before_the_latency) {
    const Scene scene = parsed(
        "name: \"s\" duration_s: 1 sensor { latency_us: 3000 } layer { track: \"a\" polygon { "
        "xy_px: [0, 0, 20, 0, 20, 20, 0, 20] } trajectory { x_px: 50 y_px: 50 vx_px_s: 100 } }");
    const SceneSimulator simulator(scene, 1);
    EXPECT_NEAR(simulator.truth(103000)[0].x_px, 50 + 10 + 10, 1e-9);  // the centre of the square
}

TEST(Truth, counts_a_point_outside_the_image_as_hidden) {
    const Scene scene = parsed(
        "name: \"s\" sensor { width: 64 height: 64 } layer { track: \"a\" model_points: 80 polygon "
        "{ xy_px: [-10, -10, 10, -10, 10, 10, -10, 10] } trajectory { x_px: 63.6 y_px: 32 } }");
    // Left of x = 63.5 lie the left side and half of the upper and lower ones.
    EXPECT_NEAR(SceneSimulator(scene, 1).truth(0)[0].visible_fraction, 0.5, 0.03);
}

TEST(Models, are_about_their_centre_of_gravity_with_every_corner_a_point) {
    const Scene scene = parsed(
        "name: \"s\" layer { track: \"a\" model_points: 40 polygon { xy_px: [0, 0, 30, 0, 30, 10, "
        "0, 10] } trajectory { x_px: 50 y_px: 60 } }");
    const SceneSimulator simulator(scene, 1);
    const auto& model = simulator.models().at(0).true_model;
    EXPECT_EQ(model.points.size(), 40U);
    Point mean = Point::Zero();
    for (const Point& p : model.points) mean += p;
    EXPECT_LT(mean.norm(), 1e-9);
    for (const Point& corner : {Point(-15, -5), Point(15, -5), Point(15, 5), Point(-15, 5)}) {
        EXPECT_EQ(std::count_if(model.points.begin(), model.points.end(),
                                [&](const Point& p) { return (p - corner).norm() < 1e-9; }),
                  1);
    }
    EXPECT_NEAR(simulator.truth(0)[0].x_px, 65, 1e-9);
    EXPECT_NEAR(simulator.truth(0)[0].y_px, 65, 1e-9);
}

}  // namespace
}  // namespace pursuit::sensor
