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

}  // namespace
}  // namespace pursuit::sensor
