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
    "threshold: 0.3 mismatch: 0 jitter_us: 0 latency_us: 0 noise_hz: 0 hot_pixels: 0 ";
const std::string small_image = "width: 64 height: 32 ";

/// A tall bar of reflectance 0.1 on 0.5, moving right at 100 px/s over every pixel from 10 to 50.
std::string bar_text(const std::string& sensor) {
    return "name: \"bar\" duration_s: 0.5 background_reflectance: 0.5 sensor { " + ideal_sensor +
           small_image + sensor +
           " } layer { polygon { xy_px: [-100, -100, 0, -100, 0, 200, -100, 200] "
           "reflectance: 0.1 } trajectory { x_px: 5 vx_px_s: 100 } }";
}

Scene bar(const std::string& sensor) { return scene_of(bar_text(sensor)); }

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
    const std::string noise = "noise_hz: 0";
    std::string text = bar_text("");
    const Scene scene = scene_of(text.replace(text.find(noise), noise.size(), "noise_hz: 5"));
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

/// Events by brute force: every pixel looks every `step_us`.
std::vector<Event> brute_force(const Scene& scene, std::int64_t step_us, std::int64_t end_us) {
    const DrawnScene drawn = draw_scene(scene, 1);
    const double blur_px = drawn.sensor.blur_px();
    ImageEdges edges(drawn, std::sqrt(blur_px * blur_px + 1.0 / 12));
    ActivePixels all(drawn.geometry, drawn.background_reflectance, 0.8);
    const auto look = [&](std::int64_t t_us) {
        for (std::size_t i = 0; i < drawn.layers.size(); ++i) {
            const double t_s = static_cast<double>(t_us) / 1e6;
            PlanarMap map = image_from_layer(drawn, drawn.layers[i], t_s);
            if (!drawn.layers[i].there(t_us)) map.matrix(0, 2) = 1e6;
            edges.place(i, map);
        }
        return all.brightness_of_all(edges);
    };
    PixelArray pixels(drawn.geometry, drawn.sensor, 1, look(0));
    std::vector<Event> events;
    for (std::int64_t t_us = step_us; t_us <= end_us; t_us += step_us) {
        const auto brightness = look(t_us);
        for (std::uint32_t i = 0; i < brightness.size(); ++i) {
            pixels.look(i, t_us - step_us, t_us, brightness[i], events);
        }
    }
    return events;
}

/// Compares by pixel; `speed_px_s` makes times into ways.
void expect_the_same(const std::vector<Event>& events, const std::vector<Event>& expected,
                     double speed_px_s) {
    using ByPixel = std::map<std::pair<int, int>, std::vector<Event>>;
    ByPixel ours;
    ByPixel theirs;
    for (const Event& e : events) ours[{e.x, e.y}].push_back(e);
    for (const Event& e : expected) theirs[{e.x, e.y}].push_back(e);
    std::size_t pixels = 0;
    std::size_t other = 0;  // a threshold just reached, or just not
    double sum_px = 0;
    std::size_t matched = 0;
    for (const auto& [place, list] : theirs) {
        const auto& mine = ours[place];
        ++pixels;
        bool same = mine.size() == list.size();
        for (std::size_t i = 0; same && i < list.size(); ++i) {
            same = mine[i].polarity == list[i].polarity;
        }
        if (!same) {
            ++other;
            continue;
        }
        for (std::size_t i = 0; i < list.size(); ++i) {
            const double way_px =
                std::abs(static_cast<double>(mine[i].t_us - list[i].t_us)) * speed_px_s / 1e6;
            sum_px += way_px;
            ++matched;
        }
    }
    EXPECT_GT(matched, 1000U);
    EXPECT_LE(static_cast<double>(other), 0.03 * static_cast<double>(pixels));
    EXPECT_LT(sum_px / static_cast<double>(matched), 0.01);
    EXPECT_NEAR(static_cast<double>(events.size()), static_cast<double>(expected.size()),
                0.005 * static_cast<double>(expected.size()));
}

TEST(SceneSimulator, leaves_out_no_look_that_matters_at_a_turning_star) {
    for (const std::string refractory : {"0", "900"}) {
        const Scene scene = scene_of(
            "name: \"s\" duration_s: 0.04 background_reflectance: 0.8 sensor { " + ideal_sensor +
            " refractory_us: " + refractory +
            " width: 80 height: 80 } layer { shape { kind: STAR size_px: 20 reflectance: 0.1 } "
            "trajectory { disc { centre_x_px: 40 centre_y_px: 40 radius_px: 12 rpm: 670 } } }");
        expect_the_same(all_events(scene, 1, 5000), brute_force(scene, 25, 40000), 2000);
    }
}

TEST(SceneSimulator, leaves_out_no_look_that_matters_where_edges_come_back_after_a_blindness) {
    const Scene scene = scene_of(
        "name: \"s\" duration_s: 0.04 background_reflectance: 0.8 sensor { " + ideal_sensor +
        " refractory_us: 900 width: 64 height: 64 } layer { shape { kind: ARROW size_px: 16 "
        "reflectance: 0.1 } trajectory { disc { centre_x_px: 32 centre_y_px: 32 radius_px: 12 rpm: "
        "3000 } } }");
    expect_the_same(all_events(scene, 1, 5000), brute_force(scene, 8, 40000), 8000);
}

TEST(SceneSimulator, leaves_out_no_look_that_matters_where_slow_and_fast_layers_overlap) {
    const Scene scene = scene_of(
        "name: \"s\" duration_s: 0.4 background_reflectance: 0.4 sensor { " + ideal_sensor +
        " refractory_us: 900 width: 100 height: 50 } "
        "layer { shape { kind: VAN size_px: 50 reflectance: 0.9 } trajectory { x_px: 20 y_px: 28 "
        "vx_px_s: 150 } } "
        "layer { shape { kind: RECTANGLE size_px: 6 aspect: 9 reflectance: 0.2 } trajectory { "
        "x_px: 70 y_px: 25 } } "
        "layer { shape { kind: CAR size_px: 40 reflectance: 0.1 } trajectory { x_px: 60 y_px: 20 "
        "vx_px_s: 12 } }");
    expect_the_same(all_events(scene, 1, 5000), brute_force(scene, 200, 400000), 150);
}

TEST(SceneSimulator, leaves_out_no_look_that_matters_where_layers_come_and_go) {
    const Scene scene = scene_of(
        "name: \"s\" duration_s: 0.2 background_reflectance: 0.4 sensor { " + ideal_sensor +
        " refractory_us: 900 width: 80 height: 60 } "
        "layer { to_s: 0.1 shape { kind: VAN size_px: 50 reflectance: 0.9 } trajectory { x_px: 30 "
        "y_px: 28 vx_px_s: 100 } } "
        "layer { from_s: 0.06 shape { kind: STAR size_px: 20 reflectance: 0.1 } trajectory { "
        "x_px: 50 y_px: 30 omega_rad_s: 4 } } ");
    const auto events = all_events(scene, 1, 5000);
    // In brute force a change lasts its whole step.
    expect_the_same(events, brute_force(scene, 50, 200000), 100);
    const auto at = [&](std::int64_t t_us) {
        return std::count_if(events.begin(), events.end(),
                             [&](const Event& e) { return e.t_us >= t_us - 1 && e.t_us <= t_us; });
    };
    EXPECT_GT(at(60000), 100);  // the van hides most of the star
    EXPECT_GT(at(100000), 300);
    EXPECT_LT(at(80000), 50);
}

TEST(SceneSimulator, counts_what_is_not_there_as_hidden_and_lets_it_hide_nothing) {
    const Scene scene = scene_of(
        "name: \"s\" duration_s: 1 sensor { " + ideal_sensor + small_image +
        " } layer { track: \"front\" to_s: 0.5 shape { kind: RECTANGLE size_px: 28 } trajectory { "
        "x_px: 32 y_px: 16 } } layer { track: \"behind\" shape { kind: STAR size_px: 10 } "
        "trajectory "
        "{ x_px: 32 y_px: 16 } }");
    const SceneSimulator simulator(scene, 1);
    EXPECT_EQ(simulator.truth(499999)[0].visible_fraction, 1);
    EXPECT_EQ(simulator.truth(499999)[1].visible_fraction, 0);
    EXPECT_EQ(simulator.truth(500000)[0].visible_fraction, 0);
    EXPECT_EQ(simulator.truth(500000)[1].visible_fraction, 1);
}

TEST(SceneSimulator, hides_what_is_behind_a_layer_in_front) {
    // A star turns behind a larger square of its own background's brightness.
    const std::string begin = "name: \"s\" duration_s: 0.2 background_reflectance: 0.8 sensor { " +
                              ideal_sensor + small_image + " } ";
    const std::string star =
        "layer { track: \"star\" shape { kind: STAR size_px: 10 reflectance: 0.1 } trajectory { "
        "x_px: 32 y_px: 16 omega_rad_s: 20 } } ";
    const std::string square =
        "layer { shape { kind: RECTANGLE size_px: 28 reflectance: 0.8 } trajectory { x_px: 32 "
        "y_px: 16 } } ";
    const auto seen = all_events(scene_of(begin + star + square), 1, 5000);
    const auto hidden = all_events(scene_of(begin + square + star), 1, 5000);
    EXPECT_GT(seen.size(), 1000U);
    EXPECT_EQ(hidden.size(), 0U);
    EXPECT_EQ(SceneSimulator(scene_of(begin + star + square), 1).truth(0)[0].visible_fraction, 1);
    EXPECT_EQ(SceneSimulator(scene_of(begin + square + star), 1).truth(0)[0].visible_fraction, 0);
}

TEST(SceneSimulator, gives_no_event_of_what_stands_still) {
    const Scene scene = scene_of(
        "name: \"s\" duration_s: 1 sensor { " + ideal_sensor + small_image +
        " } layer { shape { kind: STAR size_px: 10 reflectance: 0.1 } trajectory { x_px: 32 y_px: "
        "16 key { t_s: 0.2 x_px: 0 } key { t_s: 0.4 x_px: 5 } } }");
    const auto events = all_events(scene, 1, 5000);
    EXPECT_GT(events.size(), 50U);
    for (const Event& e : events) {
        EXPECT_GT(e.t_us, 200000);
        EXPECT_LT(e.t_us, 405000);  // the last look after a slow stop is at most 5 ms late
    }
}

TEST(SceneSimulator, goes_on_for_ever_where_the_scene_states_no_duration) {
    const Scene scene = scene_of("name: \"s\" sensor { width: 16 height: 16 noise_hz: 10 }");
    SceneSimulator simulator(scene, 1);
    EXPECT_FALSE(simulator.duration_us());
    std::vector<Event> events;
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(simulator.next(1000000, events));
    // 100 s of 256 pixels at 10 Hz and 10 at 60 Hz, each blind for 0.9 ms after an event.
    const double expected = 100 * (246 * 10 / (1 + 0.009) + 10 * 60 / (1 + 0.054));
    EXPECT_NEAR(static_cast<double>(events.size()), expected, 4 * std::sqrt(expected));
}

}  // namespace
}  // namespace pursuit::sensor
