// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/formats.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;

std::string format_of(const std::string& path, std::string_view head) {
    const auto format = find_format(path, head);
    return format ? std::string((*format)->name) : format.error().message;
}

const std::string all_names = "dat, es, raw, evt2, evt21, evt3, nmnist, aedat2, aedat4, csv, rpg";

TEST(Formats, are_told_by_extension_and_else_by_content) {
    EXPECT_EQ(format_of("a.dat", "no header"), "dat");
    EXPECT_EQ(format_of("a.DAT", ""), "dat");
    EXPECT_EQ(format_of("a.txt", "1.0 2 3 1"), "rpg");
    EXPECT_EQ(format_of("a", "% Data file\n"), "dat");
    EXPECT_EQ(format_of("a", "1.0 2 3 1\n"), "rpg");
    EXPECT_EQ(format_of("a.xyz", "\x01\x02"), "a.xyz: is in no known format (" + all_names + ")");
}

TEST(Formats, a_recording_of_topics_is_told_from_what_is_unknown) {
    EXPECT_EQ(format_of("run.mcap", "\x89MCAP0\r\n"),
              "run.mcap: is an MCAP recording, of topics: use info or replay");
}

TEST(Formats, an_unknown_name_is_answered_with_those_there_are) {
    ReadOptions options;
    options.format = "evt9";
    const std::uint8_t byte = 1;
    const auto reader = open_events(from_memory("a", {&byte, 1}), options);
    ASSERT_FALSE(reader);
    EXPECT_EQ(reader.error().message, "no format is named \"evt9\"; there are " + all_names);
}

TEST(Formats, opening_says_what_is_missing_or_a_folder) {
    const test::TemporaryFolder folder;
    EXPECT_THAT(open_events(folder.path("a.dat")).error().message,
                HasSubstr("a.dat: cannot open: No such file"));
    EXPECT_THAT(open_events(folder.path(".")).error().message, HasSubstr("is a folder"));
}

TEST(Formats, creating_needs_an_extension_that_can_be_written) {
    EXPECT_THAT(create_events("/tmp/a.txt", {2, 2}).error().message,
                HasSubstr("no format that can be written"));
}

TEST(ByteWindow, gives_every_byte_once_whatever_the_sizes_asked_for) {
    std::vector<std::uint8_t> bytes(10'000);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 7);
    ByteWindow window(from_memory("m", bytes), 64);
    std::vector<std::uint8_t> read;
    for (std::size_t wanted = 1;; wanted = wanted * 5 % 97) {
        EXPECT_EQ(window.offset(), read.size());
        const auto ahead = window.ahead(wanted);
        ASSERT_TRUE(ahead);
        if (ahead->empty()) break;
        EXPECT_GE(ahead->size(), std::min({wanted, std::size_t{64}, bytes.size() - read.size()}));
        const auto take = std::min(ahead->size(), 1 + wanted / 2);
        read.insert(read.end(), ahead->begin(), ahead->begin() + static_cast<long>(take));
        window.consume(take);
    }
    EXPECT_EQ(read, bytes);
}

}  // namespace
}  // namespace pursuit::sensor
