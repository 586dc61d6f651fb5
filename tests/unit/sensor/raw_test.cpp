// SPDX-License-Identifier: Apache-2.0
// Prophesee RAW: the header, EVT2, EVT2.1 and EVT3.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "services/sensor/formats/formats.hpp"
#include "tests/unit/sensor/read_all.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;
using Events = std::vector<Event>;

const std::string evt2 = "% evt 2.0\n% geometry 64x32\n% end\n";
const std::string evt21 = "% evt 2.1\n% geometry 64x32\n% end\n";
const std::string evt3 = "% evt 3.0\n% geometry 64x32\n% end\n";

std::string bytes_of(const std::vector<std::uint16_t>& words) {
    std::string bytes;
    for (const auto word : words) bytes += little_endian(word);
    return bytes;
}

ReadAll decode_raw(const std::string& bytes, const ReadOptions& options = {},
                   std::size_t at_a_time = 1000) {
    return decode_bytes("a.raw", bytes, options, at_a_time);
}

Geometry raw_geometry_of(const std::string& bytes) {
    auto reader = open_events(
        from_memory("a.raw", {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
    return reader ? (*reader)->geometry() : Geometry{};
}

TEST(RawHeader, states_format_and_geometry_in_either_way_and_may_lack_the_geometry) {
    EXPECT_EQ(raw_geometry_of("% evt 2.0\n"), (Geometry{640, 480}));
    EXPECT_EQ(raw_geometry_of("% evt 3.0\r\n% end\r\n"), (Geometry{1280, 720}));
    EXPECT_EQ(raw_geometry_of("% evt 2.1\n% geometry 320x320\n% end\n"), (Geometry{320, 320}));
    EXPECT_EQ(raw_geometry_of("% format EVT3;height=720;width=1282\n% end\n"),
              (Geometry{1282, 720}));
    EXPECT_EQ(raw_geometry_of("% format EVT21;endianness=legacy;height=2;width=3\n"),
              (Geometry{3, 2}));
}

TEST(RawHeader, names_the_byte_and_cause_of_what_is_wrong) {
    EXPECT_EQ(decode_raw("% Date x\n\x2d\x8b").error,
              "a.raw: byte 9: the header ends without a line \"% evt\" or \"% format\": name the "
              "format");
    EXPECT_EQ(decode_raw("% evt 4.0\n").error,
              "a.raw: byte 10: the header states evt 4.0; 2.0, 2.1 and 3.0 are read");
    EXPECT_THAT(decode_raw("% evt 3.0\n% geometry 0x5\n").error,
                HasSubstr("a.raw: byte 10: \"0\" x \"5\" is not a size"));
    EXPECT_THAT(decode_raw("% format EVT3;width=5000;height=5\n").error,
                HasSubstr("\"5000\" x \"5\" is not a size"));
    ReadOptions options;
    options.format = "evt2";
    EXPECT_EQ(decode_raw("% evt 3.0\n", options).error,
              "a.raw: byte 0: the header states evt 3.0, not 2.0");
    std::string lines;
    for (int i = 0; i < 2000; ++i) lines += "% x\n";
    EXPECT_THAT(decode_raw(lines).error, HasSubstr("more than 1000 header lines"));
}

TEST(RawHeader, words_that_begin_like_a_line_are_words) {
    // 0x2025: an event at x 37; its bytes are "% ".
    EXPECT_EQ(decode_raw("% evt 3.0\n" + bytes_of({0x8001, 0x0007})).error, "");
    const auto all = decode_raw("% evt 3.0\n% geometry 64x32\n" + bytes_of({0x2025, 0x8001}));
    EXPECT_EQ(all.error, "a.raw: byte 27: an event before the first TIME_HIGH has no time");
}

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
                   high2(0xfff'fff0) + high2(1) + word2(1, 0, 1, 1));
    EXPECT_EQ(all.error, "");
    const std::int64_t wrap = std::int64_t{1} << 34;
    EXPECT_EQ(all.events, (Events{{wrap - 1, 1, 1, 1}, {wrap, 1, 1, 1}, {2 * wrap + 64, 1, 1, 1}}));
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

std::string word21(std::uint64_t kind, std::uint64_t time, std::uint64_t x, std::uint64_t y,
                   std::uint32_t valid, bool swapped = false) {
    const auto word = kind << 60 | time << 54 | x << 43 | y << 32 | valid;
    return little_endian(swapped ? word << 32 | word >> 32 : word);
}

std::string high21(std::uint64_t time, bool swapped = false) {
    const auto word = std::uint64_t{8} << 60 | time << 32;
    return little_endian(swapped ? word << 32 | word >> 32 : word);
}

TEST(Evt21Reader, reads_vectors_lowest_bit_first_in_either_order_of_halves) {
    for (const bool swapped : {false, true}) {
        const auto header =
            swapped ? "% format EVT21;endianness=legacy;height=32;width=64\n% end\n" : evt21;
        const auto bytes = header + high21(2, swapped) +
                           word21(1, 3, 32, 31, 0x8000'0005, swapped) +
                           word21(10, 0, 0, 0, 1, swapped) + word21(0, 4, 0, 7, 1, swapped) +
                           word21(0, 5, 0, 7, 0, swapped);
        const Events expected = {
            {131, 32, 31, 1}, {131, 34, 31, 1}, {131, 63, 31, 1}, {132, 0, 7, 0}};
        for (const std::size_t at_a_time : {1, 2, 3, 100}) {
            const auto all = decode_raw(bytes, {}, at_a_time);
            EXPECT_EQ(all.error, "");
            EXPECT_EQ(all.events, expected);
        }
    }
}

TEST(Evt21Reader, delivers_the_good_events_before_each_kind_of_bad_one) {
    const auto good = evt21 + high21(2) + word21(1, 3, 0, 1, 1);
    const auto at = "a.raw: byte " + std::to_string(good.size()) + ": ";
    for (const auto& [bad, cause] : std::vector<std::pair<std::string, std::string>>{
             {word21(1, 3, 64, 1, 1), "pixel (64, 1) is outside 64x32"},
             {word21(0, 3, 1, 32, 1), "pixel (1, 32) is outside 64x32"},
             {word21(1, 2, 1, 1, 1), "time goes back from 131 to 130 us"},
             {word21(5, 2, 1, 1, 1), "a word of kind 5, which EVT2.1 does not define"},
             {"abc", "the file ends within a word, after 3 of 8 bytes"}}) {
        const auto all = decode_raw(good + bad);
        EXPECT_EQ(all.events, (Events{{131, 0, 1, 1}}));
        EXPECT_EQ(all.error, at + cause);
    }
    // A vector that runs over the edge: its pixels inside are good.
    const auto all = decode_raw(good + word21(1, 3, 60, 1, 0xff));
    EXPECT_EQ(all.events.size(), 5U);
    EXPECT_EQ(all.error, at + "pixel (64, 1) is outside 64x32");
    ReadOptions options;
    options.joined_late = true;
    EXPECT_EQ(decode_raw(evt21 + word21(1, 3, 0, 1, 0xff) + high21(1), options).skipped, 8U);
    EXPECT_THAT(decode_raw(evt21 + word21(1, 3, 0, 1, 1)).error, HasSubstr("has no time"));
}

std::uint16_t word3(unsigned kind, unsigned payload) {
    return static_cast<std::uint16_t>(kind << 12 | payload);
}

TEST(Evt3Reader, reads_single_events_and_vectors) {
    const auto bytes =
        evt3 +
        bytes_of({word3(8, 1), word3(6, 5), word3(0, 31), word3(2, 63 | 1 << 11),
                  word3(3, 2 | 1 << 11), word3(4, 0x801), word3(5, 0x102), word3(5, 0x80),
                  word3(10, 0), word3(14, 5), word3(7, 1), word3(15, 2), word3(6, 6), word3(2, 0)});
    const Events expected = {{4101, 63, 31, 1}, {4101, 2, 31, 1},  {4101, 13, 31, 1},
                             {4101, 15, 31, 1}, {4101, 29, 31, 1}, {4102, 0, 31, 0}};
    for (const std::size_t at_a_time : {1, 2, 100}) {
        const auto all = decode_raw(bytes, {}, at_a_time);
        EXPECT_EQ(all.error, "");
        EXPECT_EQ(all.events, expected);
    }
}

TEST(Evt3Reader, time_follows_time_high) {
    const auto all = decode_raw(
        evt3 + bytes_of({word3(0, 1), word3(8, 1), word3(6, 100), word3(6, 90), word3(2, 1),
                         word3(8, 1), word3(2, 2), word3(8, 2), word3(2, 3), word3(8, 0xfff),
                         word3(2, 4), word3(8, 0), word3(6, 7), word3(2, 5)}));
    EXPECT_EQ(all.error, "");
    // A TIME_LOW that steps back is no wrap; the same TIME_HIGH again changes nothing, another one
    // begins at 0.
    EXPECT_EQ(all.events, (Events{{4186, 1, 1, 0},
                                  {4186, 2, 1, 0},
                                  {8192, 3, 1, 0},
                                  {0xfff000, 4, 1, 0},
                                  {(1 << 24) + 7, 5, 1, 0}}));
}

TEST(Evt3Reader, delivers_the_good_events_before_each_kind_of_bad_one) {
    const auto good = evt3 + bytes_of({word3(8, 1), word3(6, 9), word3(0, 1), word3(2, 1)});
    const auto size = good.size();
    const auto at = [&](std::size_t byte) { return "a.raw: byte " + std::to_string(byte) + ": "; };
    for (const auto& [bad, error] : std::vector<std::pair<std::string, std::string>>{
             {bytes_of({word3(2, 64)}), at(size) + "pixel (64, 1) is outside 64x32"},
             {bytes_of({word3(0, 32), word3(2, 1)}),
              at(size + 2) + "pixel (1, 32) is outside 64x32"},
             {bytes_of({word3(6, 8), word3(2, 1)}),
              at(size + 2) + "time goes back from 4105 to 4104 us"},
             {bytes_of({word3(8, 0), word3(2, 1)}),
              at(size + 2) + "time goes back from 4105 to 0 us"},
             {bytes_of({word3(4, 1)}),
              at(size) + "a vector before the first VECT_BASE_X has no column"},
             {bytes_of({word3(9, 1)}), at(size) + "a word of kind 9, which EVT3 does not define"},
             {"a", at(size) + "the file ends within a word, after 1 of 2 bytes"}}) {
        const auto all = decode_raw(good + bad);
        EXPECT_EQ(all.events, (Events{{4105, 1, 1, 0}}));
        EXPECT_EQ(all.error, error);
    }
    const auto edge = decode_raw(good + bytes_of({word3(3, 62), word3(4, 0xfff)}));
    EXPECT_EQ(edge.events.size(), 3U);
    EXPECT_EQ(edge.error, at(size + 2) + "pixel (64, 1) is outside 64x32");
}

TEST(Evt3Reader, an_event_needs_time_and_row_and_is_skipped_without_where_one_joins_late) {
    EXPECT_THAT(decode_raw(evt3 + bytes_of({word3(0, 1), word3(2, 1)})).error,
                HasSubstr("an event before the first TIME_HIGH has no time"));
    EXPECT_THAT(decode_raw(evt3 + bytes_of({word3(8, 1), word3(2, 1)})).error,
                HasSubstr("an event before the first ADDR_Y has no row"));
    ReadOptions options;
    options.joined_late = true;
    const auto all =
        decode_raw(evt3 + bytes_of({word3(2, 1), word3(4, 7), word3(0, 1), word3(6, 4), word3(8, 1),
                                    word3(2, 1), word3(6, 5), word3(4, 3), word3(2, 2)}),
                   options);
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(all.events, (Events{{4101, 2, 1, 0}}));
    EXPECT_EQ(all.skipped, 7U);
}

/// EVT3 as its description says, one word after the other; stops at a bad event.
ReadAll reference3(const std::vector<std::uint16_t>& words) {
    ReadAll all;
    std::int64_t high = 0;
    std::int64_t low = 0;
    std::int64_t last_us = 0;
    unsigned y = 0;
    unsigned base = 0;
    unsigned base_polarity = 0;
    const auto add = [&](unsigned x, unsigned polarity) {
        const auto t_us = high * 4096 + low;
        if (x >= 64 || y >= 32 || t_us < last_us) return false;
        last_us = t_us;
        all.events.push_back({t_us, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                              static_cast<std::uint8_t>(polarity)});
        return true;
    };
    for (const auto word : words) {
        const auto payload = word & 0xfffU;
        bool ok = true;
        switch (word >> 12) {
            case 0:
                y = payload & 0x7ff;
                break;
            case 2:
                ok = add(payload & 0x7ff, payload >> 11);
                break;
            case 3:
                base = payload & 0x7ff;
                base_polarity = payload >> 11;
                break;
            case 4:
            case 5: {
                const unsigned count = word >> 12 == 4 ? 12 : 8;
                for (unsigned i = 0; i < count && ok; ++i) {
                    if ((payload >> i & 1) == 1) ok = add(base + i, base_polarity);
                }
                base += count;
                break;
            }
            case 6:
                low = payload;
                break;
            case 8:
                if (payload != high % 4096) low = 0;
                if (high % 4096 > payload + 2048) high += 4096;
                high = high / 4096 * 4096 + payload;
                last_us = std::max(last_us, high * 4096);
                break;
            default:
                break;
        }
        if (!ok) {
            all.error = "bad";
            return all;
        }
    }
    return all;
}

TEST(Evt3Reader, agrees_with_a_plain_decoder_on_random_streams_however_they_arrive) {
    std::mt19937 random(3);
    const auto below = [&](unsigned n) { return static_cast<unsigned>(random() % n); };
    for (int round = 0; round < 100; ++round) {
        std::vector<std::uint16_t> words = {word3(8, below(4096)), word3(0, 3), word3(3, 0)};
        unsigned high = words[0] & 0xfff;
        unsigned low = 0;
        const auto count = below(3000);
        for (unsigned i = 0; i < count; ++i) {
            switch (below(9)) {
                case 0:
                    words.push_back(word3(0, below(32)));
                    break;
                case 1:
                    words.push_back(word3(3, below(40) | below(2) << 11));
                    words.push_back(word3(4, below(4096)));
                    words.push_back(word3(5, below(256)));
                    break;
                case 2:
                    if (low < 4000) words.push_back(word3(6, low += below(20)));
                    break;
                case 3:
                    if (below(30) == 0) {
                        high = (high + 1 + (below(4) == 0 ? below(1000) : 0)) % 4096;
                        low = 0;
                        words.push_back(word3(8, high));
                    }
                    break;
                case 4:
                    if (below(40) == 0) words.push_back(word3(14, below(4096)));
                    break;
                default:
                    words.push_back(word3(
                        2, below(round % 3 == 0 && below(900) == 0 ? 80 : 64) | below(2) << 11));
            }
        }
        const auto expected = reference3(words);
        const auto bytes = evt3 + bytes_of(words);
        for (const auto& all : {decode_raw(bytes, {}, 1 + below(500)),
                                decode_chunks("a.raw", bytes, 1 + below(90), {}, 1 + below(500))}) {
            EXPECT_EQ(all.events, expected.events);
            EXPECT_EQ(all.error.empty(), expected.error.empty()) << all.error;
        }
    }
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
