// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/pixel_array.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace pursuit::sensor {
namespace {

disk::SceneSensor ideal(std::uint32_t refractory_us) {
    disk::SceneSensor sensor;
    sensor.set_threshold(0.3);
    sensor.set_mismatch(0);
    sensor.set_refractory_us(refractory_us);
    sensor.set_jitter_us(0);
    sensor.set_noise_hz(0);
    sensor.set_hot_pixels(0);
    return sensor;
}

constexpr Geometry one_pixel{1, 1};

/// Looks every 100 us at a brightness whose logarithm changes by `per_ms` a millisecond.
std::vector<Event> ramp(const disk::SceneSensor& sensor, double per_ms, std::int64_t end_us) {
    PixelArray pixels(one_pixel, sensor, 1, {0.1F});
    std::vector<Event> events;
    for (std::int64_t t_us = 100; t_us <= end_us; t_us += 100) {
        const double brightness = 0.1 * std::exp(per_ms * static_cast<double>(t_us) / 1000);
        pixels.look(0, t_us - 100, t_us, static_cast<float>(brightness), events);
    }
    return events;
}

TEST(PixelArray, fires_at_each_threshold_without_a_refractory_period) {
    const auto events = ramp(ideal(0), 0.1, 10000);  // up by 1.0 in 10 ms: at 3, 6, 9 ms
    ASSERT_EQ(events.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(static_cast<double>(events[i].t_us), 3000.0 * static_cast<double>(i + 1), 1);
        EXPECT_EQ(events[i].polarity, 1);
    }
}

TEST(PixelArray, fires_off_where_it_gets_darker) {
    const auto events = ramp(ideal(0), -0.1, 4000);
    ASSERT_EQ(events.size(), 1U);
    EXPECT_NEAR(static_cast<double>(events[0].t_us), 3000, 1);
    EXPECT_EQ(events[0].polarity, 0);
}

TEST(PixelArray, takes_its_reference_anew_at_the_end_of_the_refractory_period) {
    // Fires at 3 ms, is blind to 5.5 ms, and rises by 0.3 from what it sees then: 8.5 ms. A pixel
    // that kept the reference of its event would fire at 6 and 9 ms.
    const auto events = ramp(ideal(2500), 0.1, 10000);
    ASSERT_EQ(events.size(), 2U);
    EXPECT_NEAR(static_cast<double>(events[0].t_us), 3000, 1);
    EXPECT_NEAR(static_cast<double>(events[1].t_us), 8500, 2);
}

TEST(PixelArray, never_fires_twice_within_the_refractory_period) {
    for (const double per_ms : {0.5, 3.0, 20.0}) {
        const auto events = ramp(ideal(700), per_ms, 4000);
        ASSERT_GE(events.size(), 2U);
        for (std::size_t i = 1; i < events.size(); ++i) {
            EXPECT_GE(events[i].t_us - events[i - 1].t_us, 700);
        }
    }
}

TEST(PixelArray, sees_nothing_of_a_flash_while_it_is_blind) {
    PixelArray pixels(one_pixel, ideal(1000), 1, {0.1F});
    std::vector<Event> events;
    pixels.look(0, 0, 100, 0.2F, events);
    ASSERT_EQ(events.size(), 1U);
    pixels.look(0, 100, 200, 0.9F, events);
    pixels.look(0, 200, 300, 0.2F, events);
    pixels.look(0, 300, 5000, 0.2F, events);
    EXPECT_EQ(events.size(), 1U);
}

TEST(PixelArray, adds_latency_and_jitter_of_the_stated_size) {
    disk::SceneSensor sensor = ideal(0);
    sensor.set_latency_us(500);
    sensor.set_jitter_us(20);
    const std::size_t count = 20000;
    PixelArray pixels({200, 100}, sensor, 3, std::vector<float>(count, 0.1F));
    std::vector<Event> events;
    for (std::uint32_t i = 0; i < count; ++i) pixels.look(i, 9999, 10000, 0.14F, events);
    ASSERT_EQ(events.size(), count);
    double sum = 0;
    double squares = 0;
    for (const Event& e : events) {
        const double delay = static_cast<double>(e.t_us) - 10000;
        sum += delay;
        squares += delay * delay;
        EXPECT_LE(std::abs(delay - 500), 4 * 20 + 2);
    }
    const double mean = sum / count;
    EXPECT_NEAR(mean, 500, 1);
    EXPECT_NEAR(std::sqrt(squares / count - mean * mean), 20, 0.5);
}

TEST(PixelArray, gives_each_pixel_thresholds_of_its_own) {
    disk::SceneSensor sensor = ideal(0);
    sensor.set_mismatch(0.03);
    const std::size_t count = 10000;
    // A step up by the mean threshold: half of the pixels fire.
    PixelArray pixels({100, 100}, sensor, 5, std::vector<float>(count, 0.1F));
    std::vector<Event> events;
    const auto brightness = static_cast<float>(0.1 * std::exp(0.3));
    for (std::uint32_t i = 0; i < count; ++i) pixels.look(i, 0, 1000, brightness, events);
    EXPECT_NEAR(static_cast<double>(events.size()), count / 2.0, 200);  // 4 sigma
    // One sigma lower: 16 %.
    PixelArray others({100, 100}, sensor, 6, std::vector<float>(count, 0.1F));
    events.clear();
    const auto lower = static_cast<float>(0.1 * std::exp(0.27));
    for (std::uint32_t i = 0; i < count; ++i) others.look(i, 0, 1000, lower, events);
    EXPECT_NEAR(static_cast<double>(events.size()), 0.1587 * count, 150);
}

TEST(PixelArray, makes_noise_of_the_stated_rate_over_all_pixels_and_both_polarities) {
    disk::SceneSensor sensor = ideal(1000);
    sensor.set_noise_hz(20);
    PixelArray pixels({100, 100}, sensor, 1, std::vector<float>(10000, 0.5F));
    std::vector<Event> events;
    pixels.noise(2000000, events);
    // 20 Hz × 10⁴ pixels × 2 s, less the 2 % that fall into a refractory period.
    const double expected = 400000 / (1 + 20 * 0.001);
    EXPECT_NEAR(static_cast<double>(events.size()), expected, 4 * std::sqrt(expected));
    std::size_t on = 0;
    for (const Event& e : events) on += e.polarity;
    EXPECT_NEAR(static_cast<double>(on) / static_cast<double>(events.size()), 0.5, 0.004);
}

TEST(PixelArray, has_hot_pixels_that_fire_at_their_rate) {
    disk::SceneSensor sensor = ideal(0);
    sensor.set_hot_pixels(5);
    sensor.set_hot_hz(100);
    PixelArray pixels({100, 100}, sensor, 1, std::vector<float>(10000, 0.5F));
    std::vector<Event> events;
    pixels.noise(10000000, events);
    EXPECT_NEAR(static_cast<double>(events.size()), 5000, 4 * std::sqrt(5000.0));
    std::map<std::pair<int, int>, int> counts;
    for (const Event& e : events) ++counts[{e.x, e.y}];
    EXPECT_LE(counts.size(), 5U);
}

}  // namespace
}  // namespace pursuit::sensor
