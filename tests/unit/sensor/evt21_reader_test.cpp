// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/evt21_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/sensor/raw_file.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;
using Events = std::vector<Event>;

const std::string evt21 = "% evt 2.1\n% geometry 64x32\n% end\n";

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

TEST(Evt21Reader, an_event_that_is_late_across_the_wrap_goes_back_and_time_does_not_jump) {
    const auto wrapped = evt21 + high21(0xfff'ffff) + word21(1, 63, 0, 1, 1) + high21(0) +
                         word21(1, 1, 0, 1, 1) + high21(0xfff'ffff);
    EXPECT_EQ(decode_raw(wrapped + word21(1, 63, 0, 1, 1)).error,
              "a.raw: byte " + std::to_string(wrapped.size()) +
                  ": time goes back from 17179869185 to 17179869183 us");
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

}  // namespace
}  // namespace pursuit::sensor
