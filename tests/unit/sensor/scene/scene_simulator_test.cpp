// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/scene_simulator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace pursuit::sensor {
namespace {

Scene scene_of(const std::string& text) {
    auto scene = parse_scene(text, "test");
    if (!scene) throw std::runtime_error(scene.error().message);
    return *scene;
}

std::vector<Event> all_events(const Scene& scene, std::uint64_t seed, std::int64_t slice_us) {
    SceneSimulator simulator(scene, seed);
    std::vector<Event> events;
    while (simulator.next(slice_us, events)) {
    }
    return events;
}

/// A sensor without any randomness.
const std::string ideal_sensor =
    "threshold: 0.3 mismatch: 0 jitter_us: 0 latency_us: 0 noise_hz: 0 hot_pixels: 0 "
    "width: 64 height: 32";

/// A tall bar of reflectance 0.1 on 0.5, moving right at 100 px/s over every pixel from 10 to 50.
Scene bar(const std::string& sensor) {
    return scene_of("name: \"bar\" duration_s: 0.5 background_reflectance: 0.5 sensor { " +
                    ideal_sensor + " " + sensor +
                    " } layer { polygon { xy_px: [-100, -100, 0, -100, 0, 200, -100, 200] "
                    "reflectance: 0.1 } trajectory { x_px: 5 vx_px_s: 100 } }");
}

TEST(SceneSimulator, gives_the_same_events_for_the_same_seed_however_they_are_sliced) {
    auto description = load_scene("overtake");
    ASSERT_TRUE(description);
    SceneSimulator one(*description, 7);
    SceneSimulator other(*description, 7);
    std::vector<Event> in_one;
    std::vector<Event> in_many;
    ASSERT_TRUE(one.next(300000, in_one));
    for (const std::int64_t slice_us : {1, 999, 20000, 79000, 100000, 100000}) {
        ASSERT_TRUE(other.next(slice_us, in_many));
    }
    EXPECT_EQ(one.time_us(), other.time_us());
    EXPECT_GT(in_one.size(), 1000U);
    EXPECT_TRUE(in_one == in_many);
}

TEST(SceneSimulator, gives_other_events_for_another_seed) {
    const Scene scene = bar("noise_hz: 5");
    EXPECT_FALSE(all_events(scene, 1, 10000) == all_events(scene, 2, 10000));
}

TEST(SceneSimulator, gives_events_in_time_order_inside_the_image_and_the_slice) {
    auto description = load_scene("star_3000rpm");
    ASSERT_TRUE(description);
    SceneSimulator simulator(*description, 3);
    std::vector<Event> events;
    for (int i = 0; i < 50; ++i) {
        const auto begin_us = simulator.time_us();
        events.clear();
        ASSERT_TRUE(simulator.next(1000, events));
        EXPECT_EQ(simulator.time_us(), begin_us + 1000);
        EXPECT_TRUE(std::is_sorted(events.begin(), events.end(),
                                   [](const Event& a, const Event& b) { return a.t_us < b.t_us; }));
        for (const Event& e : events) {
            ASSERT_GE(e.t_us, begin_us);
            ASSERT_LT(e.t_us, begin_us + 1000);
            ASSERT_LT(e.x, simulator.geometry().width);
            ASSERT_LT(e.y, simulator.geometry().height);
        }
    }
}

TEST(SceneSimulator, ends_at_the_scene_s_duration) {
    const Scene scene = bar("");
    SceneSimulator simulator(scene, 1);
    std::vector<Event> events;
    ASSERT_TRUE(simulator.next(10000000, events));
    EXPECT_EQ(simulator.time_us(), 500000);
    const auto count = events.size();
    EXPECT_FALSE(simulator.next(1000, events));
    EXPECT_EQ(events.size(), count);
}

TEST(SceneSimulator, fires_at_the_times_that_an_edge_s_profile_gives) {
    // Without a refractory period a pixel at x fires OFF each time ln(brightness) has fallen by
    // another 0.3. Brightness: 0.5 - 0.4 Phi(d / sigma), d = 5 + 100 t - x, sigma² = 0.25 + 1/12.
    const double sigma = std::sqrt(0.25 + 1.0 / 12);
    const int expected_count = static_cast<int>(std::log(5.0) / 0.3);  // 5
    std::vector<double> expected_d;
    for (int n = 1; n <= expected_count; ++n) {
        const double share = (0.5 - 0.5 * std::exp(-0.3 * n)) / 0.4;
        double low = -5;
        double high = 5;
        for (int i = 0; i < 60; ++i) {
            const double d = (low + high) / 2;
            (0.5 * std::erfc(-d / sigma / std::sqrt(2.0)) < share ? low : high) = d;
        }
        expected_d.push_back(low);
    }
    const auto events = all_events(bar("refractory_us: 0"), 1, 7777);
    std::map<std::pair<int, int>, std::vector<Event>> by_pixel;
    for (const Event& e : events) by_pixel[{e.x, e.y}].push_back(e);
    for (int x = 10; x <= 50; ++x) {
        for (int y = 0; y < 32; ++y) {
            const auto& here = by_pixel[{x, y}];
            ASSERT_EQ(here.size(), expected_d.size()) << x << "," << y;
            for (std::size_t n = 0; n < here.size(); ++n) {
                EXPECT_EQ(here[n].polarity, 0);
                // 0.01 px: straight lines in ln(brightness) between looks 0.1 px apart.
                const double d = 5 + 100 * static_cast<double>(here[n].t_us) / 1e6 - x;
                EXPECT_NEAR(d, expected_d[n], 0.01) << x << "," << y << " event " << n;
            }
        }
    }
}

}  // namespace
}  // namespace pursuit::sensor
