// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/rpg_text_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/sensor/read_all.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;

ReadAll decode_rpg(const std::string& text, const ReadOptions& options = {}) {
    auto reader = open_events(
        from_memory("a.txt", {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}),
        options);
    if (!reader) return {{}, reader.error().message};
    return read_all(**reader, 3);
}

TEST(RpgTextReader, reads_times_exactly_to_the_nearest_microsecond) {
    const auto all = decode_rpg(
        "0 1 2 0\n0.0000014 1 2 1\n0.0000015 1 2 1\n1.5 239 179 0\n"
        "1633953690.975950 3 4 1");
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(all.events, (std::vector<Event>{{0, 1, 2, 0},
                                              {1, 1, 2, 1},
                                              {2, 1, 2, 1},
                                              {1'500'000, 239, 179, 0},
                                              {1633953690975950, 3, 4, 1}}));
}

TEST(RpgTextReader, passes_over_empty_lines_and_remarks) {
    EXPECT_EQ(decode_rpg("# t x y p\n\n0.1 1 2 1\r\n   \n").events,
              (std::vector<Event>{{100'000, 1, 2, 1}}));
}

TEST(RpgTextReader, names_the_line_of_what_is_wrong_and_keeps_what_was_before) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"0.09 1 2 1", "time goes back from 100000 to 90000 us"},
        {"x 1 2 1", "\"x\" is not a time in seconds"},
        {". 1 2 1", "\".\" is not a time in seconds"},
        {"99999999999999999999 1 2 1", "is not a time in seconds"},
        {"9007199254.740992 1 2 1", "time 9007199254740992 us is not below 2^53 us"},
        {"0.2 1 2", "must be \"t_s x y p\""},
        {"0.2 1 2 1 1", "must be \"t_s x y p\""},
        {"0.2 -1 2 1", "must be \"t_s x y p\""},
        {"0.2 70000 2 1", "must be \"t_s x y p\""},
        {"0.2 240 2 1", "pixel (240, 2) is outside 240x180"},
        {"0.2 1 2 7", "polarity 7 is not 0 or 1"},
        {std::string(300, '1'), "the line is longer than 256 bytes"}};
    for (const auto& [bad, cause] : cases) {
        const auto all = decode_rpg("0.1 1 2 1\n" + bad + "\n0.3 1 1 1\n");
        EXPECT_EQ(all.events.size(), 1U);
        EXPECT_THAT(all.error, HasSubstr("a.txt: byte 10: line 2: "));
        EXPECT_THAT(all.error, HasSubstr(cause));
    }
}

}  // namespace
}  // namespace pursuit::sensor
