// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/live/host_time_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pursuit::sensor {
namespace {

constexpr std::int64_t begin_ns = 1'790'000'000'000'000'000;
constexpr std::int64_t second_us = 1'000'000;

/// A sensor whose clock runs `ppm` fast, heard through a way that takes 200 us and a random part.
struct Sensor {
    double ppm = 0;
    std::mt19937 random{7};

    std::int64_t host_ns(std::int64_t t_us) const {
        return begin_ns + std::llround(static_cast<double>(t_us) * 1e3 / (1 + ppm * 1e-6));
    }
    std::int64_t arrival_ns(std::int64_t t_us) {
        std::exponential_distribution<double> delay(1 / 500e3);
        return host_ns(t_us) + 200'000 + std::llround(delay(random));
    }
};

/// Heard every ms from sensor time `from_us` to `to_us`.
void hear(HostTimeMap& map, Sensor& sensor, std::int64_t from_us, std::int64_t to_us,
          std::int64_t set_by_ns = 0) {
    for (auto t_us = from_us; t_us < to_us; t_us += 1000) {
        const auto arrival_ns = sensor.arrival_ns(t_us);
        map.add(t_us, arrival_ns + set_by_ns, arrival_ns - begin_ns);
    }
}

TEST(HostTimeMap, knows_nothing_before_the_first_sample_and_again_after_a_restart) {
    HostTimeMap map;
    EXPECT_FALSE(map.host_time_ns(5));
    EXPECT_EQ(map.drift_ppm(), 0);
    map.add(1000, begin_ns, 5);
    EXPECT_EQ(map.host_time_ns(1000), begin_ns);
    EXPECT_EQ(map.host_time_ns(1500), begin_ns + 500'000);
    map.restart();
    EXPECT_FALSE(map.host_time_ns(1000));
}

TEST(HostTimeMap, finds_drift_and_time_of_a_sensor_through_a_way_of_random_delay) {
    for (const double ppm : {-300.0, 0.0, 40.0, 1000.0}) {
        HostTimeMap map;
        Sensor sensor{ppm};
        hear(map, sensor, 0, 70 * second_us);
        EXPECT_NEAR(map.drift_ppm(), ppm, 0.5);
        // The least delay cannot be seen; beyond it the map is good to a few us.
        for (const auto t_us : {10 * second_us, 50 * second_us, 70 * second_us}) {
            const auto error_ns = *map.host_time_ns(t_us) - sensor.host_ns(t_us);
            EXPECT_GE(error_ns, 195'000) << ppm << " ppm at " << t_us;
            EXPECT_LE(error_ns, 215'000) << ppm << " ppm at " << t_us;
        }
    }
}

TEST(HostTimeMap, says_no_drift_before_it_has_seen_enough_of_it) {
    HostTimeMap map;
    Sensor sensor{100};
    hear(map, sensor, 0, 3 * second_us);
    EXPECT_EQ(map.drift_ppm(), 0);
    hear(map, sensor, 3 * second_us, 10 * second_us);
    EXPECT_NEAR(map.drift_ppm(), 100, 10);
}

TEST(HostTimeMap, begins_anew_when_the_host_clock_is_set) {
    HostTimeMap map;
    Sensor sensor{20};
    hear(map, sensor, 0, 20 * second_us);
    constexpr std::int64_t step_ns = 3'600'000'000'000;
    hear(map, sensor, 20 * second_us, 30 * second_us, step_ns);
    const auto t_us = 29 * second_us;
    EXPECT_NEAR(static_cast<double>(*map.host_time_ns(t_us) - sensor.host_ns(t_us) - step_ns),
                200'000, 20'000);
    EXPECT_NEAR(map.drift_ppm(), 20, 10);
}

TEST(HostTimeMap, never_says_that_an_event_happened_after_it_arrived) {
    HostTimeMap map;
    Sensor sensor{-50};
    for (std::int64_t t_us = 0; t_us < 12 * second_us; t_us += 1000) {
        const auto arrival_ns = sensor.arrival_ns(t_us);
        map.add(t_us, arrival_ns, arrival_ns - begin_ns);
        ASSERT_LE(*map.host_time_ns(t_us), arrival_ns + 1);
    }
}

}  // namespace
}  // namespace pursuit::sensor
