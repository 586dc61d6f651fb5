// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/sensor_streams.hpp"

#include <gtest/gtest.h>

namespace pursuit::recorder {
namespace {

TEST(SensorStreams, are_none_before_the_first_packet) {
    const SensorStreams streams;
    EXPECT_EQ(streams.current(1), 0U);
    EXPECT_EQ(streams.current(std::nullopt), 0U);
    EXPECT_FALSE(streams.first_sensor());
}

TEST(SensorStreams, are_numbered_for_each_sensor_in_the_order_in_which_they_begin) {
    SensorStreams streams;
    EXPECT_TRUE(streams.take(5, 900));
    EXPECT_FALSE(streams.take(5, 900));
    EXPECT_EQ(streams.current(5), 0U);
    EXPECT_TRUE(streams.take(3, 900));
    EXPECT_TRUE(streams.take(5, 100));
    EXPECT_EQ(streams.current(5), 1U);
    EXPECT_EQ(streams.current(3), 0U);
    EXPECT_FALSE(streams.take(5, 900));  // late: begins nothing, and ends nothing
    EXPECT_EQ(streams.current(5), 1U);
}

TEST(SensorStreams, of_an_unknown_sensor_are_those_of_the_first_heard) {
    SensorStreams streams;
    streams.take(5, 1);
    streams.take(3, 1);
    streams.take(5, 2);
    EXPECT_EQ(streams.first_sensor(), 5U);
    EXPECT_EQ(streams.current(std::nullopt), 1U);
}

}  // namespace
}  // namespace pursuit::recorder
