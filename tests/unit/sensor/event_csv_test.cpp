// SPDX-License-Identifier: Apache-2.0
// CSV, read and written, and the way from each writable format to each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "services/sensor/formats/csv_writer.hpp"
#include "services/sensor/formats/formats.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_data.hpp"
#include "tests/unit/sensor/read_all.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;
using Events = std::vector<Event>;

const std::string csv_header = "# geometry 64x32\nt_us,x,y,p\n";

ReadAll decode_csv(const std::string& text, const ReadOptions& options = {}) {
    return decode_bytes("a.csv", text, options, 3);
}

TEST(CsvReader, reads_its_own_header_foreign_ones_and_none) {
    const Events expected = {{5, 63, 31, 1}, {6, 0, 0, 0}};
    for (const std::string text :
         {"# geometry 64x32\nt_us,x,y,p\n5,63,31,1\n6,0,0,0\n",
          "%geometry:64,32\nx,y,polarity,timestamp\n63,31,1,5\n0,0,0,6\n",
          "#geometry 64x32\r\n\r\n5, 63, 31, 1\r\n# remark\r\n6 ,0 ,0 ,0\r\n",
          "y,t,more,p,x\n# geometry 64x32\n31,5,abc,1,63\n0,6,,0,0\n"}) {
        const auto all = decode_csv(text);
        EXPECT_EQ(all.error, "") << text;
        EXPECT_EQ(all.events, expected) << text;
    }
    ReadOptions options;
    options.geometry = Geometry{64, 32};
    EXPECT_EQ(decode_csv("5,63,31,1\n6,0,0,0\n", options).events, expected);
}

TEST(CsvReader, must_know_its_geometry_and_columns) {
    EXPECT_EQ(
        decode_csv("5,63,31,1\n").error,
        "a.csv: byte 0: line 0: no line \"# geometry WxH\" before here states the pixels, and "
        "none are named");
    for (const std::string names : {"t,x,y", "t,x,y,p,p", "time,x,y,p", "a,b"}) {
        EXPECT_EQ(
            decode_csv("# geometry 64x32\n" + names + "\n").error,
            "a.csv: byte 17: line 2: must name the columns t_us, x, y and p (or be numbers in "
            "this order)");
    }
}

TEST(CsvReader, names_the_line_of_what_is_wrong_and_keeps_what_was_before) {
    for (const auto& [bad, cause] : std::vector<std::pair<std::string, std::string>>{
             {"4,1,1,1", "time goes back from 5 to 4 us"},
             {"-1,1,1,1", "time goes back from 5 to -1 us"},
             {"6,64,1,1", "pixel (64, 1) is outside 64x32"},
             {"6,1,32,1", "pixel (1, 32) is outside 64x32"},
             {"9007199254740992,1,1,1", "time 9007199254740992 us is not below 2^53 us"},
             {"9223372036854775807,1,1,1", "time 9223372036854775807 us is not below 2^53 us"},
             {"6,1,1,2", "polarity 2 is not 0 or 1"},
             {"6,1,1", "must be 4 columns with the whole numbers t_us, x, y and p"},
             {"6,1,1,1,1", "must be 4 columns with the whole numbers t_us, x, y and p"},
             {"6.5,1,1,1", "must be 4 columns with the whole numbers t_us, x, y and p"},
             {"6,,1,1", "must be 4 columns with the whole numbers t_us, x, y and p"},
             {"99999999999999999999,1,1,1",
              "must be 4 columns with the whole numbers t_us, x, y and p"},
             {std::string(2000, '1'), "the line is longer than 1024 bytes"}}) {
        const auto all = decode_csv(csv_header + "5,1,2,1\n" + bad + "\n7,1,1,1\n");
        EXPECT_EQ(all.events, (Events{{5, 1, 2, 1}}));
        EXPECT_EQ(all.error, "a.csv: byte 36: line 4: " + cause);
    }
}

TEST(CsvReader, a_last_line_without_its_end_is_whole_only_where_its_last_number_cannot_go_on) {
    const auto named = [](const std::string& names) { return "# geometry 64x32\n" + names + "\n"; };
    for (const std::string last : {"5,63,31,1", "5,63,31,1\n"}) {
        const auto all = decode_csv(csv_header + last);
        EXPECT_EQ(all.error, "");
        EXPECT_EQ(all.events, (Events{{5, 63, 31, 1}}));
    }
    const auto remarked = decode_csv(named("t_us,x,y,p,more") + "5,63,31,1,ab");
    EXPECT_EQ(remarked.error, "");
    EXPECT_EQ(remarked.events, (Events{{5, 63, 31, 1}}));
    for (const auto& [names, lines] :
         std::vector<std::pair<std::string, std::string>>{{"x,y,p,t_us", "63,31,1,5\n6,6,0,6"},
                                                          {"t_us,p,y,x", "5,1,31,63\n6,0,6,6"},
                                                          {"t_us,p,x,y", "5,1,63,31\n6,0,6,6"}}) {
        const auto cut = decode_csv(named(names) + lines);
        EXPECT_EQ(cut.events, (Events{{5, 63, 31, 1}}));
        EXPECT_EQ(cut.error,
                  "a.csv: byte 38: line 4: the file ends within it: no end of line follows");
        const auto whole = decode_csv(named(names) + lines + "\r\n");
        EXPECT_EQ(whole.error, "");
        EXPECT_EQ(whole.events, (Events{{5, 63, 31, 1}, {6, 6, 6, 0}}));
    }
}

TEST(CsvWriter, says_where_it_cannot_create) {
    EXPECT_FALSE(create_csv("/nonexistent/a.csv", {1, 1}));
    EXPECT_FALSE(create_csv("/dev/null", {0, 1}));
    auto full = create_csv("/dev/full", {1, 1});
    EXPECT_THAT((*full)->close().error().message, HasSubstr("No space left"));
}

Events random_events(std::int64_t first_us) {
    std::mt19937 random(6);
    Events events;
    auto t_us = first_us;
    for (int i = 0; i < 3000; ++i) {
        t_us += static_cast<std::int64_t>(random() % (i % 100 == 0 ? 100'000 : 30));
        events.push_back({t_us, static_cast<std::uint16_t>(random() % 640),
                          static_cast<std::uint16_t>(random() % 480),
                          static_cast<std::uint8_t>(random() % 2)});
    }
    return events;
}

void write_file(const std::string& path, const Events& events, Geometry geometry) {
    auto writer = create_events(path, geometry);
    ASSERT_TRUE(writer) << writer.error().message;
    ASSERT_TRUE((*writer)->write(events));
    ASSERT_TRUE((*writer)->close());
}

TEST(RoundTrip, through_every_writable_format_in_turn_loses_nothing) {
    const test::TemporaryFolder folder;
    auto events = random_events(4'000'000'000);
    for (const std::string name : {"1.dat", "2.es", "3.csv", "4.es", "5.dat", "6.csv", "7.dat"}) {
        write_file(folder.path(name), events, {640, 480});
        const auto all = read_file(folder.path(name));
        ASSERT_EQ(all.error, "");
        ASSERT_EQ(all.events, events) << name;
        events = all.events;
    }
    EXPECT_EQ(test::content_of(folder.path("1.dat")), test::content_of(folder.path("7.dat")));
    EXPECT_EQ(test::content_of(folder.path("2.es")), test::content_of(folder.path("4.es")));
}

TEST(RoundTrip, csv_holds_any_time_below_2_to_the_53rd) {
    const test::TemporaryFolder folder;
    const auto events = random_events(9'007'199'240'000'000);
    write_file(folder.path("a.csv"), events, {640, 480});
    EXPECT_EQ(read_file(folder.path("a.csv")).events, events);
}

TEST(RoundTrip, of_real_recordings_loses_nothing) {
    const test::TemporaryFolder folder;
    for (const std::string name : {"decoders/evt3_triggers.raw", "decoders/nmnist_digit.bin"}) {
        PURSUIT_DATA_OR_SKIP(path, name);
        auto reader = open_events(path);
        const auto geometry = (*reader)->geometry();
        const auto events = read_all(**reader).events;
        for (const std::string copy : {"a.dat", "a.es", "a.csv"}) {
            write_file(folder.path(copy), events, geometry);
            EXPECT_EQ(read_file(folder.path(copy)).events, events) << name << " as " << copy;
        }
    }
}

}  // namespace
}  // namespace pursuit::sensor
