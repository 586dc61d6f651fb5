// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/chunk_messages.hpp"

#include <gtest/gtest.h>

#include "services/recorder/mcap/compression.hpp"

namespace pursuit::recorder::mcap {
namespace {

/// A chunk with messages 1 and 2 on two channels, as the file reader would load it.
class TwoMessages : public ::testing::Test {
 protected:
    TwoMessages() {
        Bytes records;
        for (const std::uint16_t id : {std::uint16_t{1}, std::uint16_t{2}}) {
            append(records, Channel{id, 0, "topic", "cdr", {}});
            append(records, MessageHead{id, id, 2, 3}, Bytes{});
        }
        ChunkHead head;
        head.uncompressed_bytes = records.size();
        head.uncompressed_crc = crc32(0, records);
        head.records = records;
        append(content_, head);
        content_.erase(content_.begin(), content_.begin() + record_head_bytes);
    }

    void load() {
        const auto faults = chunk_.load(content_, {}, definitions_);
        ASSERT_TRUE(faults) << faults.error().message;
        EXPECT_TRUE(faults->empty());
    }

    Bytes content_;
    Definitions definitions_{ReadLimits().definition_bytes};
    ChunkMessages chunk_;
};

TEST_F(TwoMessages, come_in_turn_with_their_channels) {
    EXPECT_FALSE(chunk_.next(definitions_));
    load();
    for (const std::uint16_t id : {std::uint16_t{1}, std::uint16_t{2}}) {
        const auto message = chunk_.next(definitions_);
        ASSERT_TRUE(message);
        EXPECT_EQ(message->head.channel_id, id);
        EXPECT_EQ(message->channel, definitions_.channel(id));
    }
    EXPECT_FALSE(chunk_.next(definitions_));
}

TEST_F(TwoMessages, are_followed_by_one_index_for_each_channel) {
    load();
    EXPECT_TRUE(chunk_.take_index(2, 16));
    EXPECT_FALSE(chunk_.take_index(2, 16));
    EXPECT_FALSE(chunk_.take_index(3, 16));
    EXPECT_TRUE(chunk_.take_index(3, 0));  // without entries it says nothing wrong
    EXPECT_TRUE(chunk_.awaits_index());
    EXPECT_TRUE(chunk_.take_index(1, 16));
    EXPECT_FALSE(chunk_.awaits_index());
}

TEST_F(TwoMessages, of_a_damaged_chunk_are_none_and_its_indexes_are_not_judged) {
    content_.back() ^= 1;
    EXPECT_FALSE(chunk_.load(content_, {}, definitions_));
    EXPECT_FALSE(chunk_.next(definitions_));
    EXPECT_FALSE(chunk_.awaits_index());
    EXPECT_TRUE(chunk_.take_index(3, 16));
    content_.back() ^= 1;
    load();
    EXPECT_FALSE(chunk_.take_index(3, 16));
    chunk_.discard();
    EXPECT_FALSE(chunk_.next(definitions_));
    EXPECT_TRUE(chunk_.take_index(3, 16));
}

}  // namespace
}  // namespace pursuit::recorder::mcap
