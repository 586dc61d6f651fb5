// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/dat_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "services/sensor/formats/formats.hpp"
#include "tests/support/test_data.hpp"
#include "tests/unit/sensor/read_all.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;

const std::string plain_header = "% Version 2\n% Width 64\n% Height 32\n\x0c\x08";

std::string word(std::uint32_t t_us, std::uint32_t address) {
    std::string bytes(8, '\0');
    std::memcpy(bytes.data(), &t_us, 4);
    std::memcpy(bytes.data() + 4, &address, 4);
    return bytes;
}

std::string v2(std::uint32_t t_us, std::uint32_t x, std::uint32_t y, std::uint32_t polarity) {
    return word(t_us, x | y << 14 | polarity << 28);
}

/// What a string of bytes decodes to; the error also where it cannot be opened.
ReadAll decode_dat(const std::string& bytes, const ReadOptions& options = {},
                   std::size_t at_a_time = 1000) {
    auto reader = open_events(
        from_memory("a.dat", {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}),
        options);
    if (!reader) return {{}, reader.error().message};
    return read_all(**reader, at_a_time);
}

Geometry dat_geometry_of(const std::string& bytes) {
    auto reader = open_events(
        from_memory("a.dat", {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
    return reader ? (*reader)->geometry() : Geometry{};
}

TEST(DatReader, reads_version_2_with_the_geometry_of_its_header) {
    const auto bytes = plain_header + v2(5, 63, 31, 1) + v2(5, 0, 0, 0) + v2(9, 1, 2, 1);
    EXPECT_EQ(dat_geometry_of(bytes), (Geometry{64, 32}));
    const auto all = decode_dat(bytes);
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(all.events, (std::vector<Event>{{5, 63, 31, 1}, {5, 0, 0, 0}, {9, 1, 2, 1}}));
}

TEST(DatReader, reads_version_1) {
    const auto bytes = "% Version 1\n" + std::string("\0\x08", 2) +
                       word(7, 303 | 239 << 9 | 1 << 17) + word(8, 1 | 2 << 9);
    EXPECT_EQ(dat_geometry_of(bytes), (Geometry{304, 240}));
    EXPECT_EQ(decode_dat(bytes).events, (std::vector<Event>{{7, 303, 239, 1}, {8, 1, 2, 0}}));
}

TEST(DatReader, tells_the_version_of_a_file_without_header_by_its_bits) {
    EXPECT_EQ(decode_dat(v2(1, 3, 200, 0)).events, (std::vector<Event>{{1, 3, 200, 0}}));
    EXPECT_EQ(decode_dat(v2(1, 3, 2, 1)).events, (std::vector<Event>{{1, 3, 2, 1}}));
    EXPECT_EQ(decode_dat(word(1, 3 | 200 << 9 | 1 << 17)).events,
              (std::vector<Event>{{1, 3, 200, 1}}));
}

TEST(DatReader, an_asked_for_geometry_goes_over_the_header) {
    ReadOptions options;
    options.geometry = Geometry{1280, 720};
    EXPECT_EQ(decode_dat(plain_header + v2(1, 1279, 719, 0), options).error, "");
}

TEST(DatReader, takes_a_header_with_windows_line_ends_and_remarks) {
    EXPECT_EQ(dat_geometry_of("%\r\n% Width 640\r\n% Height 480\r\n%% end\r\n\x0c\x08"),
              (Geometry{640, 480}));
}

TEST(DatReader, a_header_without_events_is_an_empty_recording) {
    const auto all = decode_dat(plain_header);
    EXPECT_EQ(all.error, "");
    EXPECT_TRUE(all.events.empty());
}

TEST(DatReader, names_the_byte_and_cause_of_what_is_wrong_in_a_header) {
    EXPECT_EQ(decode_dat("").error, "a.dat: byte 0: the file is empty");
    EXPECT_EQ(decode_dat("% Version 3\n\x0c\x08").error,
              "a.dat: byte 0: Version \"3\" is not a number from 1 to 2");
    EXPECT_EQ(decode_dat("% Version 2\n% Width x\n\x0c\x08").error,
              "a.dat: byte 12: Width \"x\" is not a number from 1 to 16384");
    EXPECT_EQ(decode_dat("% Height 99999\n\x0c\x08").error,
              "a.dat: byte 0: Height \"99999\" is not a number from 1 to 16384");
    EXPECT_EQ(decode_dat("% Width 5\n\x0c\x08").error,
              "a.dat: byte 10: the header states Width but no Height");
    EXPECT_EQ(decode_dat("% Version 2").error, "a.dat: byte 0: a header line does not end");
    EXPECT_EQ(decode_dat("% Version 2\n\x0c").error,
              "a.dat: byte 12: the file ends before the type and size of its events");
    EXPECT_EQ(decode_dat("% Version 2\n\x0e\x08").error,
              "a.dat: byte 12: events of type 14 are not change detection events (0 or 12)");
    EXPECT_EQ(decode_dat("% Version 2\n\x0c\x10").error,
              "a.dat: byte 13: events of 16 bytes, must be 8");
}

TEST(DatReader, refuses_a_header_without_end_in_bounded_memory) {
    EXPECT_THAT(decode_dat("%" + std::string(1 << 20, 'x')).error, HasSubstr("does not end"));
    std::string lines;
    for (int i = 0; i < 2000; ++i) lines += "% x\n";
    EXPECT_THAT(decode_dat(lines).error, HasSubstr("more than 1000 header lines"));
}

TEST(DatReader, delivers_the_good_events_before_each_kind_of_bad_one) {
    const auto good = v2(5, 1, 1, 0) + v2(6, 2, 2, 1);
    const auto at = std::to_string(plain_header.size() + good.size());
    const std::vector<std::pair<std::string, std::string>> cases = {
        {v2(4, 1, 1, 0), "time goes back from 6 to 4 us"},
        {v2(7, 64, 1, 0), "pixel (64, 1) is outside 64x32"},
        {v2(7, 1, 32, 0), "pixel (1, 32) is outside 64x32"},
        {v2(7, 1, 1, 2), "polarity 2 is not 0 or 1"},
        {std::string(3, 'x'), "the file ends within an event, after 3 of 8 bytes"}};
    for (const auto& [bad, cause] : cases) {
        const auto all = decode_dat(plain_header + good + bad);
        EXPECT_EQ(all.events, (std::vector<Event>{{5, 1, 1, 0}, {6, 2, 2, 1}}));
        EXPECT_EQ(all.error, "a.dat: byte " + at + ": " + cause);
    }
}

TEST(DatReader, keeps_returning_its_error) {
    const auto bytes = plain_header + v2(7, 64, 1, 0);
    auto reader = open_events(
        from_memory("a.dat", {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
    std::vector<Event> block(4);
    EXPECT_FALSE((*reader)->read(block));
    EXPECT_FALSE((*reader)->read(block));
    EXPECT_EQ((*reader)->events_read(), 0U);
}

TEST(DatReader, unwraps_time_at_32_bits_as_often_as_it_wraps) {
    const std::uint32_t high = 0xffff'fff0;
    const auto all =
        decode_dat(plain_header + v2(high, 0, 0, 0) + v2(3, 0, 0, 0) + v2(0x7000'0000, 0, 0, 0) +
                   v2(0x9000'0000, 0, 0, 0) + v2(high, 0, 0, 0) + v2(4, 0, 0, 0));
    ASSERT_EQ(all.error, "");
    const std::int64_t wrap = std::int64_t{1} << 32;
    EXPECT_EQ(all.events[0].t_us, high);
    EXPECT_EQ(all.events[1].t_us, wrap + 3);
    EXPECT_EQ(all.events[4].t_us, wrap + high);
    EXPECT_EQ(all.events[5].t_us, 2 * wrap + 4);
}

TEST(DatReader, an_event_that_is_late_across_the_wrap_goes_back_and_time_does_not_jump) {
    const auto before = v2(0xffff'fff0, 1, 1, 0) + v2(5, 1, 1, 0);
    const std::string late = v2(0xffff'fff8, 1, 1, 0);
    std::string rest;
    for (std::uint32_t t_us = 7; t_us < 3000; ++t_us) rest += v2(t_us, 1, 1, 0);
    for (const auto& between : {std::string(), rest}) {
        const auto all = decode_dat(plain_header + before + between + late + rest);
        EXPECT_EQ(all.events.size(), 2 + between.size() / 8);
        EXPECT_THAT(all.error,
                    HasSubstr("byte " + std::to_string(plain_header.size() + 16 + between.size())));
        EXPECT_THAT(all.error, HasSubstr(between.empty() ? "from 4294967301 to 4294967288 us"
                                                         : "from 4294970295 to 4294967288 us"));
    }
    // Before any wrap a rise is a rise, however large.
    EXPECT_EQ(decode_dat(plain_header + v2(5, 1, 1, 0) + late).error, "");
}

/// The decoder written as its description says, one event after the other.
ReadAll reference(const std::string& bytes, Geometry geometry) {
    ReadAll all;
    std::int64_t epoch = 0;
    std::uint32_t last = 0;
    for (std::size_t i = plain_header.size(); i + 8 <= bytes.size(); i += 8) {
        std::uint32_t t_us = 0;
        std::uint32_t address = 0;
        std::memcpy(&t_us, bytes.data() + i, 4);
        std::memcpy(&address, bytes.data() + i + 4, 4);
        const auto x = address & 0x3fff;
        const auto y = address >> 14 & 0x3fff;
        const auto polarity = address >> 28;
        const bool wrap = last > t_us && last - t_us > 0x8000'0000U;
        if (x >= geometry.width || y >= geometry.height || polarity > 1 || (t_us < last && !wrap) ||
            (epoch > 0 && t_us > last && t_us - last > 0x8000'0000U)) {
            all.error = "bad";
            return all;
        }
        if (wrap) epoch += std::int64_t{1} << 32;
        last = t_us;
        all.events.push_back({epoch + t_us, static_cast<std::uint16_t>(x),
                              static_cast<std::uint16_t>(y), static_cast<std::uint8_t>(polarity)});
    }
    return all;
}

TEST(DatReader, agrees_with_a_plain_decoder_on_random_streams_read_in_any_size) {
    std::mt19937 random(1);
    const auto any = [&] { return static_cast<std::uint32_t>(random()); };
    const auto below = [&](std::uint32_t n) { return any() % n; };
    for (int round = 0; round < 60; ++round) {
        std::string bytes = plain_header;
        std::uint32_t t_us = any();
        const auto events = below(5000);
        const auto bad = below(2) == 0 ? below(6000) : 6000;
        for (std::uint32_t i = 0; i < events; ++i) {
            t_us += below(10) == 0 ? below(1 << 22) : below(3);
            bytes += i == bad ? word(any(), any()) : v2(t_us, below(64), below(32), below(2));
        }
        const auto expected = reference(bytes, {64, 32});
        const auto all = decode_dat(bytes, {}, 1 + below(2000));
        EXPECT_EQ(all.events, expected.events);
        EXPECT_EQ(all.error.empty(), expected.error.empty()) << all.error;
    }
}

}  // namespace
}  // namespace pursuit::sensor
