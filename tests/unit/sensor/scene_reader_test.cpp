// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace pursuit::sensor {
namespace {

TEST(SceneReader, delivers_events_and_the_grey_level_that_each_pixel_came_to) {
    const auto scene = parse_scene(
        "name: 's' duration_s: 0.4 background_reflectance: 0.5 sensor { width: 32 height: 16 "
        "threshold: 0.3 mismatch: 0 jitter_us: 0 noise_hz: 0 hot_pixels: 0 refractory_us: 100 "
        "exposure_us: 1000 } layer { polygon { xy_px: [-100, -100, 0, -100, 0, 200, -100, 200] "
        "reflectance: 0.1 } trajectory { x_px: 2 vx_px_s: 100 } }",
        "s");
    ASSERT_TRUE(scene) << scene.error().message;
    SceneReader reader(*scene, 1);
    EXPECT_TRUE(reader.has_exposures());
    // Small, unequal spans: nothing may be lost or come out of order at their ends.
    std::vector<Event> events(7);
    std::vector<Event> exposures(3);
    std::int64_t until_us = 0;
    std::size_t event_count = 0;
    std::map<std::pair<int, int>, std::int64_t> begun_us;
    std::map<std::pair<int, int>, double> grey;
    for (;;) {
        const auto batch = reader.read(events, exposures);
        ASSERT_TRUE(batch);
        if (batch->at_end) break;
        std::int64_t latest_us = until_us;
        for (std::size_t i = 0; i < batch->events; ++i) {
            ASSERT_GE(events[i].t_us, until_us);
            latest_us = std::max(latest_us, events[i].t_us);
        }
        for (std::size_t i = 0; i < batch->exposures; ++i) {
            const Event& e = exposures[i];
            ASSERT_GE(e.t_us, until_us);
            latest_us = std::max(latest_us, e.t_us);
            const std::pair<int, int> pixel{e.x, e.y};
            if (e.polarity == 0) begun_us[pixel] = e.t_us;
            if (e.polarity == 1)
                grey[pixel] = 1000.0 / static_cast<double>(e.t_us - begun_us[pixel]);
        }
        until_us = latest_us;
        event_count += batch->events;
    }
    EXPECT_GT(event_count, 500U);
    // The bar has passed column 10 long before the end: the last event was at about its edge.
    ASSERT_GT(grey.size(), 100U);
    for (int y = 0; y < 16; ++y) EXPECT_NEAR(grey.at({10, y}), 0.12, 0.03);
}

TEST(SceneReader, returns_soon_from_a_silence_without_an_end_and_says_that_it_goes_on) {
    const auto scene = parse_scene(
        "name: 's' duration_s: 1 background_reflectance: 0.5 sensor { width: 8 height: 8 "
        "mismatch: 0 jitter_us: 0 noise_hz: 0 hot_pixels: 0 }",
        "s");
    ASSERT_TRUE(scene) << scene.error().message;
    SceneReader reader(*scene, 1);
    std::vector<Event> events(7);
    int calls = 0;
    for (;;) {
        const auto batch = reader.read(events, {});
        ASSERT_TRUE(batch);
        EXPECT_EQ(batch->events, 0U);
        if (batch->at_end) break;
        ++calls;
    }
    EXPECT_GE(calls, 9);
    EXPECT_LE(calls, 10);
}

}  // namespace
}  // namespace pursuit::sensor
