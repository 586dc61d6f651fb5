// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/facts.hpp"

#include <gmock/gmock.h>

#include "services/recorder/mcap/schema_text.hpp"

namespace pursuit::recorder::mcap {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(McapFacts, how_a_topic_was_offered_comes_back_from_the_channel) {
    ReplayFacts facts;
    facts.type_name = "pursuit::v1::ObjectPose";
    facts.keyed = true;
    facts.partitions = {"", "front"};
    facts.reliability = Reliability::best_effort;
    facts.durability = Durability::transient_local;
    facts.history_depth = 16;
    facts.ownership = Ownership::exclusive;
    facts.deadline_ns = 50'000'000;
    facts.writer_guid = "0123456789abcdef0123456789abcdef";
    ReplayFacts plain;
    plain.type_name = "T";
    for (const auto& each : {facts, plain}) {
        const Channel channel{1, 1, "pursuit/poses", "cdr", to_metadata(each)};
        const auto back = replay_facts(channel);
        ASSERT_TRUE(back) << back.error().message;
        ASSERT_TRUE(*back);
        EXPECT_EQ(**back, each);
    }
}

TEST(McapFacts, a_foreign_channel_has_none) {
    const auto facts = replay_facts({1, 1, "/tf", "cdr", {{"offered_qos_profiles", ""}}});
    ASSERT_TRUE(facts);
    EXPECT_FALSE(*facts);
}

TEST(McapFacts, a_value_that_cannot_be_read_is_named) {
    ReplayFacts plain;
    plain.type_name = "T";
    for (const auto& [key, value] : StringMap{{"pursuit.keyed", "yes"},
                                              {"pursuit.history_depth", "-1"},
                                              {"pursuit.deadline_ns", "5 s"},
                                              {"pursuit.durability", ""},
                                              {"pursuit.history_depth", "99999999999999999999"}}) {
        auto metadata = to_metadata(plain);
        metadata[key] = value;
        const auto facts = replay_facts({1, 1, "pursuit/poses", "cdr", metadata});
        ASSERT_FALSE(facts) << key;
        EXPECT_THAT(facts.error().message,
                    HasSubstr("channel pursuit/poses: metadata " + key + " is \"" + value + "\""));
    }
}

TEST(McapFacts, the_end_of_an_instance_is_its_flags_key_hash_and_key) {
    InstanceState state;
    EXPECT_EQ(encode(state), Bytes(17, 0));
    state.unregistered = true;
    Bytes expected(17, 0);
    expected[0] = 2;
    EXPECT_EQ(encode(state), expected);
    state.disposed = true;
    state.key_hash.emplace().fill(7);
    state.key = {0, 1, 0, 0, 5, 0, 0, 0};
    expected = Bytes(17, 7);  // the flags are all three as well
    expected.insert(expected.end(), state.key.begin(), state.key.end());
    EXPECT_EQ(encode(state), expected);
}

TEST(SchemaText, holds_the_type_and_all_it_uses_without_includes) {
    for (const auto* name :
         {"EventPacket", "ObjectPose", "PoseTrack", "RegisteredModel", "TrackerSettings",
          "SensorStatus", "TrackerStatus", "RecorderStatus", "TrackerRequest", "TrackerReply",
          "SensorRequest", "SensorReply", "RecorderRequest", "RecorderReply"}) {
        const auto text = schema_text(std::string("pursuit::v1::") + name);
        EXPECT_THAT(text, HasSubstr(std::string("struct ") + name + " {"));
        EXPECT_THAT(text, Not(HasSubstr("#")));
    }
    const auto reply = schema_text("pursuit::v1::TrackerReply");
    const auto first = reply.find("struct ObjectPose {");
    EXPECT_NE(first, std::string_view::npos);
    EXPECT_EQ(reply.find("struct ObjectPose {", first + 1), std::string_view::npos)
        << "a file that is included twice appears twice";
    EXPECT_LT(first, reply.find("struct RegisteredModel {"));
    EXPECT_LT(reply.find("struct RegisteredModel {"), reply.find("union TrackerResult"));
}

TEST(SchemaText, an_unknown_type_has_none) {
    EXPECT_EQ(schema_text("pursuit::v1::Nonsense"), "");
    EXPECT_EQ(schema_text("EventPacket"), "");
}

}  // namespace
}  // namespace pursuit::recorder::mcap
