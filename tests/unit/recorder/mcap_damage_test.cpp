// SPDX-License-Identifier: Apache-2.0
//
// Whatever happens to a file, a reader gives only messages that were written, in their order, and
// says what is wrong.

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "services/recorder/mcap/info.hpp"
#include "services/recorder/mcap/summary.hpp"
#include "services/recorder/mcap/time_order.hpp"
#include "tests/unit/recorder/mcap_sample.hpp"

namespace pursuit::recorder::mcap {
namespace {

/// Small, so that a mutation cannot cost much memory or time.
constexpr ReadLimits small_limits{1 << 20, 1 << 20, 1 << 20, 1 << 20};

/// Whether `part` is what is left of `whole` when messages are taken out.
bool in_order_of(const std::vector<Expected>& part, const std::vector<Expected>& whole) {
    auto at = whole.begin();
    for (const auto& message : part) {
        at = std::find(at, whole.end(), message);
        if (at == whole.end()) return false;
        ++at;
    }
    return true;
}

/// Reads in every way there is; for the sanitizers and against endless loops.
void read_every_way(const Bytes& file) {
    read_all(file, small_limits, OnDamage::skip_chunk);
    auto sorted = TimeOrderedReader::open(std::make_unique<MemoryInput>(file), "f", small_limits);
    read_all(sorted);
    for (const auto depth : {InfoDepth::summary, InfoDepth::full}) {
        const auto info = read_info(std::make_unique<MemoryInput>(file), "f", depth, small_limits);
        if (info) to_text(*info);
    }
}

TEST(McapDamage, a_file_cut_at_any_byte_gives_every_message_of_its_complete_chunks) {
    for (const auto compression : {Compression::none, Compression::zstd}) {
        const auto sample = make_sample(compression, 2, 3, 4);
        MemoryInput input(sample.file);
        const auto summary = read_summary(input);
        ASSERT_TRUE(summary);
        for (std::size_t size = 0; size < sample.file.size(); ++size) {
            const Bytes cut(sample.file.begin(),
                            sample.file.begin() + static_cast<std::ptrdiff_t>(size));
            std::size_t complete = 0;
            for (const auto& chunk : summary->chunks) {
                if (chunk.chunk_offset + chunk.chunk_bytes <= size) complete += 4;
            }
            const auto back = read_all(cut);
            ASSERT_EQ(back.messages.size(), complete) << "cut at byte " << size;
            ASSERT_TRUE(
                std::equal(back.messages.begin(), back.messages.end(), sample.messages.begin()));
            ASSERT_THAT(back.error, testing::StartsWith("run.mcap: byte ")) << "cut at " << size;

            auto sorted = TimeOrderedReader::open(std::make_unique<MemoryInput>(cut), "run.mcap");
            const auto in_time = read_all(sorted);
            ASSERT_EQ(in_time.messages, back.messages);
            ASSERT_EQ(in_time.error, back.error);
            const auto info =
                read_info(std::make_unique<MemoryInput>(cut), "run.mcap", InfoDepth::summary);
            ASSERT_EQ(info ? info->messages : 0, complete);
            if (info) {
                ASSERT_NE(info->condition, Condition::closed);
            }
        }
    }
}

TEST(McapDamage, a_flipped_byte_anywhere_is_noticed_and_changes_no_message) {
    for (const auto compression : {Compression::none, Compression::zstd}) {
        const auto sample = make_sample(compression, 2, 3, 4);
        for (std::size_t at = 0; at < sample.file.size(); ++at) {
            for (const int flip : {0x01, 0x02, 0x80, 0xFF}) {
                auto file = sample.file;
                file[at] = static_cast<std::uint8_t>(file[at] ^ flip);
                for (const auto on_damage : {OnDamage::stop, OnDamage::skip_chunk}) {
                    const auto back = read_all(file, small_limits, on_damage);
                    ASSERT_NE(back.error, "") << "byte " << at << " flipped by " << flip;
                    ASSERT_TRUE(in_order_of(back.messages, sample.messages))
                        << "byte " << at << " flipped by " << flip;
                }
                if (flip == 0x01) read_every_way(file);
            }
        }
    }
}

TEST(McapDamage, no_mutation_makes_a_reader_fail_otherwise_than_by_an_error) {
    std::mt19937 random(7);
    const auto below = [&](std::size_t n) { return static_cast<std::ptrdiff_t>(random() % n); };
    std::size_t with_messages = 0;
    for (int round = 0; round < 4000; ++round) {
        const auto compression = round % 2 == 0 ? Compression::none : Compression::zstd;
        static const Sample samples[] = {make_sample(Compression::none, 2, 2, 3),
                                         make_sample(Compression::zstd, 2, 2, 3)};
        Bytes file = samples[compression == Compression::none ? 0 : 1].file;
        for (auto edits = 1 + below(4); edits > 0 && !file.empty(); --edits) {
            const auto at = file.begin() + below(file.size());
            switch (below(6)) {
                case 0:
                    *at = static_cast<std::uint8_t>(random());
                    break;
                case 1:
                    file.erase(at, at + std::min<std::ptrdiff_t>(below(40), file.end() - at));
                    break;
                case 2:
                    file.insert(at, static_cast<std::size_t>(below(40)),
                                static_cast<std::uint8_t>(random()));
                    break;
                case 3: {  // A part again elsewhere.
                    const Bytes part(at,
                                     at + std::min<std::ptrdiff_t>(below(200), file.end() - at));
                    file.insert(file.begin() + below(file.size()), part.begin(), part.end());
                    break;
                }
                case 4:
                    file.resize(static_cast<std::size_t>(at - file.begin()));
                    break;
                default:  // A length or count that is extreme.
                    std::fill_n(at, std::min<std::ptrdiff_t>(8, file.end() - at),
                                round % 3 == 0 ? std::uint8_t{0xFF} : std::uint8_t{0});
            }
        }
        with_messages += read_all(file, small_limits).messages.empty() ? 0 : 1;
        read_every_way(file);
    }
    EXPECT_GT(with_messages, 100U) << "the mutations never reach the messages";
}

}  // namespace
}  // namespace pursuit::recorder::mcap
