// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/time_order.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "tests/unit/recorder/mcap_sample.hpp"

namespace pursuit::recorder::mcap {
namespace {

using testing::HasSubstr;

/// A file whose log times are those given, `per_chunk` to a chunk.
Bytes file_of(const std::vector<std::int64_t>& times_ns, std::size_t per_chunk, bool close) {
    const auto disk = std::make_shared<MemoryOutput::Disk>();
    auto writer = Writer::create(std::make_unique<MemoryOutput>(disk), {}, 0);
    const auto channel = writer->add_channel(0, "topic", "cdr", {});
    for (std::uint32_t i = 0; i < times_ns.size(); ++i) {
        EXPECT_TRUE(writer->write({*channel, i, times_ns[i], 0}, as_bytes(std::to_string(i))));
        if ((i + 1) % per_chunk == 0) {
            EXPECT_TRUE(writer->flush());
        }
    }
    EXPECT_TRUE(close ? writer->close() : writer->flush());
    return disk->data;
}

ReadBack sorted(const Bytes& file, ReadLimits limits = {}) {
    auto reader = TimeOrderedReader::open(std::make_unique<MemoryInput>(file), "run.mcap", limits);
    return read_all(reader);
}

TEST(McapTimeOrder, any_order_of_times_comes_back_as_a_stable_sort_would_give_it) {
    std::mt19937 random(3);
    for (int round = 0; round < 60; ++round) {
        std::vector<std::int64_t> times_ns;
        for (int i = 0; i < 50; ++i) {
            // Mostly forward, with jitter and many equal times.
            times_ns.push_back(1000 + i * (round % 3) + static_cast<std::int64_t>(random() % 20));
        }
        const auto file = file_of(times_ns, 1 + random() % 12, round % 2 == 0);
        const auto back = sorted(file);
        auto in_file_order = read_all(file).messages;
        std::stable_sort(
            in_file_order.begin(), in_file_order.end(),
            [](const auto& a, const auto& b) { return a.log_time_ns < b.log_time_ns; });
        EXPECT_EQ(back.messages, in_file_order);
        EXPECT_EQ(back.messages.size(), 50U);
        EXPECT_EQ(back.error.empty(), round % 2 == 0);
    }
}

TEST(McapTimeOrder, a_file_without_messages_gives_none) {
    EXPECT_EQ(sorted(file_of({}, 1, true)).error, "");
    EXPECT_EQ(sorted(Bytes{}).error, "run.mcap: byte 0: the file is empty");
}

TEST(McapTimeOrder, only_overlapping_chunks_are_in_memory_at_once) {
    std::vector<std::int64_t> times_ns(1000);
    for (std::size_t i = 0; i < times_ns.size(); ++i) times_ns[i] = static_cast<std::int64_t>(i);
    ReadLimits limits;
    limits.open_chunk_bytes = 1000;  // A chunk of 10 messages has about 350 bytes.
    EXPECT_EQ(sorted(file_of(times_ns, 10, true), limits).messages.size(), 1000U);
    std::fill(times_ns.begin(), times_ns.end(), 5);
    EXPECT_THAT(sorted(file_of(times_ns, 10, true), limits).error,
                HasSubstr("more than 1000 bytes of chunks overlap in time"));
}

TEST(McapTimeOrder, a_damaged_chunk_ends_the_reading_where_it_would_begin) {
    std::vector<std::int64_t> times_ns;
    for (int i = 0; i < 40; ++i) times_ns.push_back(i);
    auto file = file_of(times_ns, 10, true);
    auto reader = Reader::open(std::make_unique<MemoryInput>(file), "run.mcap");
    std::uint64_t offset = 0;
    for (int i = 0; i < 25; ++i) offset = reader->next() ? reader->chunk()->offset : 0;
    file[offset + 60] ^= 1;
    const auto back = sorted(file);
    EXPECT_EQ(back.messages.size(), 20U);
    EXPECT_THAT(back.error, HasSubstr("run.mcap: byte " + std::to_string(offset)));
}

}  // namespace
}  // namespace pursuit::recorder::mcap
