// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/evt3_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/unit/sensor/raw_file.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;
using Events = std::vector<Event>;

const std::string evt3 = "% evt 3.0\n% geometry 64x32\n% end\n";

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

TEST(Evt3Reader, an_event_that_is_late_across_the_wrap_goes_back_and_time_does_not_jump) {
    const auto wrapped =
        evt3 + bytes_of({word3(0, 1), word3(8, 0xfff), word3(6, 9), word3(2, 1), word3(8, 0),
                         word3(6, 3), word3(2, 2), word3(8, 0xfff), word3(6, 10)});
    EXPECT_EQ(decode_raw(wrapped + bytes_of({word3(2, 3)})).error,
              "a.raw: byte " + std::to_string(wrapped.size()) +
                  ": time goes back from 16777219 to 16773130 us");
    const auto all = decode_raw(wrapped + bytes_of({word3(8, 0), word3(6, 4), word3(2, 3)}));
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(all.events.back(), (Event{(1 << 24) + 4, 3, 1, 0}));
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

}  // namespace
}  // namespace pursuit::sensor
