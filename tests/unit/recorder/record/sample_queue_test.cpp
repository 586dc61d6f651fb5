// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/sample_queue.hpp"

#include <gtest/gtest.h>

namespace pursuit::recorder {
namespace {

TEST(SampleQueue, full_drops_the_newest_and_keeps_the_order) {
    const auto make = [](std::uint8_t content) {
        Sample sample;
        sample.payload.assign(100, content);
        return sample;
    };
    const auto size = SampleQueue::bytes_of(make(0));
    SampleQueue queue(3 * size);
    for (std::uint8_t i = 0; i < 3; ++i) EXPECT_TRUE(queue.push(make(i)));
    EXPECT_FALSE(queue.push(make(3)));
    EXPECT_EQ(queue.bytes(), 3 * size);
    const auto two = queue.take(std::chrono::milliseconds(0), 2);
    ASSERT_EQ(two.size(), 2U);
    EXPECT_EQ(two[0].payload[0], 0);
    EXPECT_EQ(two[1].payload[0], 1);
    EXPECT_EQ(queue.bytes(), size);
    EXPECT_TRUE(queue.push(make(4)));
    const auto rest = queue.take(std::chrono::milliseconds(0), 10);
    ASSERT_EQ(rest.size(), 2U);
    EXPECT_EQ(rest[1].payload[0], 4);
    EXPECT_EQ(queue.bytes(), 0U);
    EXPECT_TRUE(queue.take(std::chrono::milliseconds(0), 10).empty());
}

}  // namespace
}  // namespace pursuit::recorder
