// SPDX-License-Identifier: Apache-2.0
// Every recording that has a known answer.
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstring>
#include <fstream>
#include <sstream>

#include "services/sensor/formats/formats.hpp"
#include "tests/support/test_data.hpp"
#include "tests/unit/sensor/read_all.hpp"

namespace pursuit::sensor {
namespace {

struct KnownAnswer {
    std::string file;
    std::uint64_t events = 0;
    std::uint64_t on_events = 0;
    std::int64_t first_t_us = 0;
    std::int64_t last_t_us = 0;
    std::string crc32;
};

std::string packed_crc32(const std::vector<Event>& events) {
    auto crc = crc32(0, nullptr, 0);
    for (const auto& event : events) {
        std::array<unsigned char, 13> bytes;
        std::memcpy(bytes.data(), &event.t_us, 8);
        std::memcpy(bytes.data() + 8, &event.x, 2);
        std::memcpy(bytes.data() + 10, &event.y, 2);
        bytes[12] = event.polarity;
        crc = crc32(crc, bytes.data(), static_cast<uInt>(bytes.size()));
    }
    std::array<char, 9> text;
    std::snprintf(text.data(), text.size(), "%08lx", crc);
    return text.data();
}

void expect_answer(const KnownAnswer& known) {
    SCOPED_TRACE(known.file);
    auto reader = open_events((test::data_folder() / known.file).string());
    ASSERT_TRUE(reader) << reader.error().message;
    const auto all = read_all(**reader);
    EXPECT_EQ(all.error, "");
    ASSERT_EQ(all.events.size(), known.events);
    EXPECT_EQ((*reader)->events_read(), known.events);
    std::uint64_t on_events = 0;
    for (const auto& event : all.events) on_events += event.polarity;
    EXPECT_EQ(on_events, known.on_events);
    EXPECT_EQ(all.events.front().t_us, known.first_t_us);
    EXPECT_EQ(all.events.back().t_us, known.last_t_us);
    EXPECT_EQ(packed_crc32(all.events), known.crc32);
}

TEST(KnownAnswers, every_recording_gives_its_events_exactly) {
    PURSUIT_DATA_OR_SKIP(path, "known_answers.tsv");
    std::ifstream table(path);
    std::string line;
    std::getline(table, line);
    int read = 0;
    while (std::getline(table, line)) {
        std::istringstream fields(line);
        KnownAnswer known;
        fields >> known.file >> known.events >> known.on_events >> known.first_t_us >>
            known.last_t_us;
        for (int i = 0; i < 4; ++i) fields >> known.crc32;  // the ranges of x and y: in the CRC
        fields >> known.crc32;
        ASSERT_TRUE(fields) << line;
        expect_answer(known);
        ++read;
    }
    EXPECT_EQ(read, 13);
}

TEST(MalformedRecordings, end_in_an_error_that_names_file_byte_and_cause_after_the_good_events) {
    struct Case {
        std::string file;
        std::size_t events;
        std::string error;
    };
    // Those without an error are whole: a wrap of time, no events at all.
    const std::vector<Case> cases = {
        {"dat_header_only.dat", 0, ""},
        {"dat_no_type_size.dat", 0,
         "byte 91: the file ends before the type and size of its events"},
        {"dat_time_goes_back.dat", 400, "byte 3293: time goes back from 12474 to 7480 us"},
        {"dat_time_wraps_32bit.dat", 1000, ""},
        {"dat_truncated_mid_event.dat", 500,
         "byte 4093: the file ends within an event, after 3 of 8 bytes"},
        {"dat_x_out_of_range.dat", 300,
         "byte 2493: pixel (16383, 24) is outside 304x240, assumed because the header states no "
         "size"},
        {"empty.dat", 0, "byte 0: the file is empty"},
        {"es_bad_magic.es", 0, "byte 0: does not begin with \"Event Stream\""},
        {"es_reset_bytes_inside.es", 199,
         "byte 1024: the file ends within an event, after 1 of 5 bytes"},
        {"es_truncated_mid_event.es", 298,
         "byte 1521: the file ends within an event, after 1 of 5 bytes"},
        {"es_unknown_type.es", 0,
         "byte 15: a stream of type 9 holds neither DVS (1) nor ATIS events (2)"},
        {"evt2_no_time_high_first.raw", 0,
         "byte 164: an event before the first TIME_HIGH has no time"},
        {"evt3_no_evt_line_in_header.raw", 0,
         "byte 27: the header ends without a line \"% evt\" or \"% format\": name the format"},
        {"evt3_odd_byte_count.raw", 7004,
         "byte 20166: the file ends within a word, after 1 of 2 bytes"},
        {"evt3_starts_without_time_high.raw", 0,
         "byte 166: an event before the first TIME_HIGH has no time"}};
    for (const auto& known : cases) {
        PURSUIT_DATA_OR_SKIP(path, "malformed/" + known.file);
        auto reader = open_events(path);
        const auto all = reader ? read_all(**reader) : ReadAll{{}, reader.error().message};
        EXPECT_EQ(all.events.size(), known.events) << known.file;
        EXPECT_EQ(all.error, known.error.empty() ? "" : path + ": " + known.error);
        if (known.file == "dat_time_wraps_32bit.dat") {
            EXPECT_EQ(all.events.front().t_us, 4294957296);
            EXPECT_EQ(all.events.back().t_us, (std::int64_t{1} << 32) + 19258);
        }
        EXPECT_TRUE(!reader || (*reader)->events_read() == known.events);
    }
}

}  // namespace
}  // namespace pursuit::sensor
