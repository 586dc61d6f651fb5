// SPDX-License-Identifier: Apache-2.0
// The header of Prophesee RAW.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/sensor/raw_file.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;

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

TEST(RawHeader, a_line_that_is_too_long_or_no_text_is_not_taken_for_words) {
    const std::string name = "% serial_number 00000000-0000-0000-0001";
    const std::string rest = "\n% end\n" + bytes_of({0x8001, 0x0007});
    const auto error = [&](const std::string& more) {
        return decode_raw("% evt 3.0\n" + name + more).error;
    };
    EXPECT_EQ(error(std::string(4095 - name.size(), 'x') + rest), "");
    EXPECT_EQ(error(std::string(4096 - name.size(), 'x') + rest),
              "a.raw: byte 10: a header line longer than 4096 bytes");
    EXPECT_EQ(error("\x01" + rest), "a.raw: byte 10: a control character in a header line");
    EXPECT_EQ(error(""), "a.raw: byte 10: a header line does not end");
}

TEST(RawHeader, words_that_begin_like_a_line_are_words) {
    // 0x2025: an event at x 37; its bytes are "% ".
    EXPECT_EQ(decode_raw("% evt 3.0\n" + bytes_of({0x8001, 0x0007})).error, "");
    const auto all = decode_raw("% evt 3.0\n% geometry 64x32\n" + bytes_of({0x2025, 0x8001}));
    EXPECT_EQ(all.error, "a.raw: byte 27: an event before the first TIME_HIGH has no time");
}

}  // namespace
}  // namespace pursuit::sensor
