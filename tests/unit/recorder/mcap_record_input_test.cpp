// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/record_input.hpp"

#include <gtest/gtest.h>

#include "services/recorder/mcap/compression.hpp"

namespace pursuit::recorder::mcap {
namespace {

/// A file of a Header, one record of that content, and the magic at its end.
Bytes file_around(Opcode opcode, const Bytes& content) {
    Bytes file(magic.begin(), magic.end());
    append(file, Header{"", "test"});
    const auto begin = begin_record(file, opcode);
    ByteWriter(file).bytes(content);
    end_record(file, begin);
    file.insert(file.end(), magic.begin(), magic.end());
    return file;
}

/// Reads a file's Header on construction.
struct FramedFile {
    explicit FramedFile(Bytes file, std::uint64_t record_bytes = 1 << 20)
        : size(file.size()), input(std::move(file)), records(input, size, record_bytes) {
        EXPECT_TRUE(records.read_header());
    }
    std::size_t size;
    MemoryInput input;
    RecordInput records;
};

TEST(McapRecordInput, gives_head_content_and_place_of_a_record) {
    const Bytes content{1, 2, 3};
    FramedFile file(file_around(Opcode::metadata, content));
    const auto begin = file.records.position();
    const auto head = file.records.read_head();
    ASSERT_TRUE(head) << head.error().cause;
    EXPECT_EQ(head->opcode, Opcode::metadata);
    EXPECT_EQ(head->size, 3U);
    EXPECT_EQ(file.records.offset(), begin);
    const auto given = file.records.read_content(head->size);
    ASSERT_TRUE(given) << given.error().cause;
    EXPECT_EQ(Bytes(given->begin(), given->end()), content);
    EXPECT_EQ(file.records.position(), begin + record_head_bytes + 3);
    EXPECT_TRUE(file.records.read_end());
}

TEST(McapRecordInput, passes_over_a_record_larger_than_it_would_read) {
    FramedFile file(file_around(Opcode::metadata, Bytes(100, 0)), 99);
    ASSERT_TRUE(file.records.read_head());
    ASSERT_TRUE(file.records.skip(100));
    EXPECT_TRUE(file.records.read_end());

    FramedFile again(file_around(Opcode::metadata, Bytes(100, 0)), 99);
    ASSERT_TRUE(again.records.read_head());
    const auto refused = again.records.read_content(100);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().condition, Condition::damaged);
    EXPECT_EQ(refused.error().cause, "a record of 100 bytes; at most 99 are read");
    EXPECT_EQ(refused.error().offset, again.records.offset());
}

TEST(McapRecordInput, checks_a_trailing_crc_over_many_blocks) {
    Bytes content(200'000, 7);
    const auto crc = crc32(0, content);
    ByteWriter(content).u32(crc);
    FramedFile right(file_around(Opcode::attachment, content));
    ASSERT_TRUE(right.records.read_head());
    EXPECT_EQ(right.records.check_trailing_crc(content.size()).value(), true);
    EXPECT_TRUE(right.records.read_end());

    content[150'000] ^= 1;
    FramedFile wrong(file_around(Opcode::attachment, content));
    ASSERT_TRUE(wrong.records.read_head());
    EXPECT_EQ(wrong.records.check_trailing_crc(content.size()).value(), false);
}

TEST(McapRecordInput, takes_a_trailing_crc_of_zero_for_none) {
    FramedFile file(file_around(Opcode::attachment, {1, 2, 0, 0, 0, 0}));
    ASSERT_TRUE(file.records.read_head());
    EXPECT_EQ(file.records.check_trailing_crc(6).value(), true);
}

}  // namespace
}  // namespace pursuit::recorder::mcap
