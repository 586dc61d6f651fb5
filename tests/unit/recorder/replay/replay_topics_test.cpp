// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/replay_topics.hpp"

#include <gtest/gtest.h>

#include "services/common/topics.hpp"

namespace pursuit::recorder {
namespace {

TEST(ReplayTopics, without_a_wish_are_the_packets_and_the_calls_on_the_tracker) {
    for (const auto* name : {topic::events, topic::exposures, topic::tracker_request}) {
        EXPECT_TRUE(is_replayed(name, {})) << name;
    }
    for (const auto* name : {topic::poses, topic::models, topic::tracker_reply}) {
        EXPECT_FALSE(is_replayed(name, {})) << name;
    }
}

TEST(ReplayTopics, with_a_wish_are_those_alone) {
    EXPECT_TRUE(is_replayed(topic::poses, {topic::poses, topic::models}));
    EXPECT_FALSE(is_replayed(topic::events, {topic::poses, topic::models}));
}

TEST(ReplayTopics, never_are_requests_and_replies_but_for_calls_on_the_tracker) {
    for (const auto* name : {topic::tracker_request, topic::events, topic::poses}) {
        EXPECT_EQ(replay_refusal(name), "") << name;
    }
    EXPECT_EQ(replay_refusal(topic::tracker_reply), "a replay does not send pursuit/tracker/reply");
    EXPECT_NE(replay_refusal(topic::sensor_request), "");
}

}  // namespace
}  // namespace pursuit::recorder
