// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/evt2_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/unit/sensor/raw_file.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;
using Events = std::vector<Event>;

const std::string evt2 = "% evt 2.0\n% geometry 64x32\n% end\n";

std::string word2(std::uint32_t kind, std::uint32_t time, std::uint32_t x, std::uint32_t y) {
    return little_endian(kind << 28 | time << 22 | x << 11 | y);
}

std::string high2(std::uint32_t time) { return little_endian(0x8000'0000U | time); }

TEST(Evt2Reader, reads_events_and_passes_over_what_is_none) {
    const auto all =
        decode_raw(evt2 + high2(2) + word2(1, 3, 63, 31) + word2(10, 9, 9, 9) + word2(14, 0, 0, 0) +
                   word2(15, 0, 0, 0) + high2(3) + word2(0, 0, 0, 0));
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(all.events, (Events{{131, 63, 31, 1}, {192, 0, 0, 0}}));
}

TEST(Evt2Reader, unwraps_time_where_time_high_falls_by_more_than_half_of_its_range) {
    const auto all =
        decode_raw(evt2 + high2(0xfff'ffff) + word2(1, 63, 1, 1) + high2(0) + word2(1, 0, 1, 1) +
                   high2(0x800'0000) + high2(0xfff'fff0) + high2(1) + word2(1, 0, 1, 1));
    EXPECT_EQ(all.error, "");
    const std::int64_t wrap = std::int64_t{1} << 34;
    EXPECT_EQ(all.events, (Events{{wrap - 1, 1, 1, 1}, {wrap, 1, 1, 1}, {2 * wrap + 64, 1, 1, 1}}));
}

TEST(Evt2Reader, an_event_that_is_late_across_the_wrap_goes_back_and_time_does_not_jump) {
    const auto wrapped = evt2 + high2(0xfff'ffff) + word2(1, 63, 1, 1) + high2(0) +
                         word2(1, 1, 1, 1) + high2(0xfff'ffff);
    EXPECT_EQ(decode_raw(wrapped + word2(1, 63, 1, 1)).error,
              "a.raw: byte " + std::to_string(wrapped.size()) +
                  ": time goes back from 17179869185 to 17179869183 us");
    // A time without an event is passed over, as every other that goes back.
    const auto all = decode_raw(wrapped + high2(0) + word2(1, 2, 1, 1));
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(all.events.back().t_us, (std::int64_t{1} << 34) + 2);
}

TEST(Evt2Reader, an_event_before_the_first_time_is_an_error_or_skipped_where_one_joins_late) {
    const auto bytes = evt2 + word2(1, 3, 1, 1) + word2(0, 4, 1, 1) + high2(1) + word2(1, 0, 2, 2);
    const auto strict = decode_raw(bytes);
    EXPECT_EQ(strict.error, "a.raw: byte " + std::to_string(evt2.size()) +
                                ": an event before the first TIME_HIGH has no time");
    ReadOptions options;
    options.joined_late = true;
    const auto late = decode_raw(bytes, options);
    EXPECT_EQ(late.error, "");
    EXPECT_EQ(late.events, (Events{{64, 2, 2, 1}}));
    EXPECT_EQ(late.skipped, 2U);
}

TEST(Evt2Reader, delivers_the_good_events_before_each_kind_of_bad_one) {
    const auto good = evt2 + high2(2) + word2(1, 3, 1, 1);
    const auto at = "a.raw: byte " + std::to_string(good.size()) + ": ";
    for (const auto& [bad, cause] : std::vector<std::pair<std::string, std::string>>{
             {word2(1, 3, 64, 1), "pixel (64, 1) is outside 64x32"},
             {word2(0, 3, 1, 32), "pixel (1, 32) is outside 64x32"},
             {word2(1, 2, 1, 1), "time goes back from 131 to 130 us"},
             {word2(5, 2, 1, 1), "a word of kind 5, which EVT2 does not define"},
             {"abc", "the file ends within a word, after 3 of 4 bytes"}}) {
        const auto all = decode_raw(good + bad);
        EXPECT_EQ(all.events, (Events{{131, 1, 1, 1}}));
        EXPECT_EQ(all.error, at + cause);
    }
    EXPECT_THAT(decode_raw("% evt 2.0\n" + high2(2) + word2(1, 3, 640, 1)).error,
                HasSubstr("is outside 640x480, assumed because the header states no size"));
}

TEST(Evt2Reader, on_a_live_stream_tells_time_without_events_and_holds_none_back) {
    ReadOptions options;
    options.format = "evt2";
    options.geometry = Geometry{64, 32};
    auto reader = open_events(
        std::make_unique<ChunkSource>(
            "live", std::deque<std::string>{high2(1), high2(5), word2(1, 3, 1, 1) + "ab", "c"},
            false),
        options);
    ASSERT_TRUE(reader);
    std::vector<Event> events(10);
    EXPECT_FALSE((*reader)->read(events, {})->at_end);
    EXPECT_EQ((*reader)->time_us(), 64);
    EXPECT_EQ((*reader)->read(events, {})->events, 0U);
    EXPECT_EQ((*reader)->time_us(), 320);
    EXPECT_EQ((*reader)->read(events, {})->events, 1U);
    EXPECT_EQ((*reader)->time_us(), 323);
    EXPECT_EQ((*reader)->read(events, {}).error().message, "waited");
}

TEST(Evt2Reader, agrees_with_a_plain_decoder_on_random_streams_however_they_arrive) {
    std::mt19937 random(4);
    const auto below = [&](unsigned n) { return static_cast<unsigned>(random() % n); };
    for (int round = 0; round < 60; ++round) {
        std::string bytes = evt2;
        Events expected;
        std::uint32_t high = below(1000);
        bytes += high2(high);
        bool bad = false;
        unsigned low = 0;
        for (unsigned i = below(3000); i > 0 && !bad; --i) {
            if (below(50) == 0) {
                bytes += high2(high += 1 + below(3));
                low = 0;
            }
            if (below(60) == 0) bytes += word2(14, below(64), below(2048), below(2048));
            low = std::min(63U, low + (below(6) == 0 ? 1 : 0));
            const auto x = below(64);
            const auto y = below(round % 2 == 0 && below(1000) == 0 ? 40 : 32);
            const auto polarity = below(2);
            bytes += word2(polarity, low, x, y);
            bad = y >= 32;
            if (!bad) {
                expected.push_back({high * 64 + low, static_cast<std::uint16_t>(x),
                                    static_cast<std::uint16_t>(y),
                                    static_cast<std::uint8_t>(polarity)});
            }
        }
        for (const auto& all : {decode_raw(bytes, {}, 1 + below(500)),
                                decode_chunks("a.raw", bytes, 1 + below(90), {}, 1 + below(500))}) {
            EXPECT_EQ(all.events, expected);
            EXPECT_EQ(all.error.empty(), !bad) << all.error;
        }
    }
}

}  // namespace
}  // namespace pursuit::sensor
