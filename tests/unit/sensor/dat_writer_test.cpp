// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/dat_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/sensor/formats/formats.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_data.hpp"
#include "tests/unit/sensor/read_all.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;

TEST(DatWriter, what_it_writes_is_read_back_unchanged) {
    const test::TemporaryFolder folder;
    const auto path = folder.path("a.dat");
    const std::vector<Event> events = {
        {0, 0, 0, 0}, {0, 639, 479, 1}, {4294967295, 5, 6, 1}, {4294967296, 7, 8, 0}};
    auto writer = create_dat(path, {640, 480});
    ASSERT_TRUE(writer);
    ASSERT_TRUE((*writer)->write(std::span(events).first(1)));
    // Half an hour a step: what the reader can unwrap.
    std::vector<Event> all = {events[0]};
    for (std::int64_t t_us = 0; t_us < 9'000'000'000; t_us += 1'800'000'000) {
        all.push_back({t_us, 1, 2, 1});
    }
    ASSERT_TRUE((*writer)->write(std::span(all).subspan(1)));
    ASSERT_TRUE((*writer)->close());
    const auto read = read_file(path);
    EXPECT_EQ(read.error, "");
    EXPECT_EQ(read.events, all);
}

TEST(DatWriter, no_events_make_an_empty_recording) {
    const test::TemporaryFolder folder;
    auto writer = create_dat(folder.path("a.dat"), {3, 2});
    ASSERT_TRUE((*writer)->close());
    auto reader = open_events(folder.path("a.dat"));
    ASSERT_TRUE(reader);
    EXPECT_EQ((*reader)->geometry(), (Geometry{3, 2}));
    EXPECT_TRUE(read_all(**reader).events.empty());
}

TEST(DatWriter, refuses_events_that_no_reader_would_take_and_keeps_those_before) {
    const std::vector<std::pair<Event, std::string>> cases = {
        {{9, 1, 1, 0}, "event 1: time goes back from 10 to 9 us"},
        {{10, 64, 1, 0}, "event 1: pixel (64, 1) is outside 64x32"},
        {{10, 1, 32, 0}, "event 1: pixel (1, 32) is outside 64x32"},
        {{10, 1, 1, 2}, "event 1: polarity 2 is not 0 or 1"},
        {{5'000'000'000, 1, 1, 0}, "cannot hold the step of time from 10 to 5000000000 us"}};
    for (const auto& [bad, cause] : cases) {
        const test::TemporaryFolder folder;
        const auto path = folder.path("a.dat");
        auto writer = create_dat(path, {64, 32});
        const std::vector<Event> events = {{10, 1, 1, 0}, bad};
        const auto ok = (*writer)->write(events);
        ASSERT_FALSE(ok);
        EXPECT_THAT(ok.error().message, HasSubstr(path + ": "));
        EXPECT_THAT(ok.error().message, HasSubstr(cause));
        EXPECT_EQ((*writer)->events_written(), 1U);
        ASSERT_TRUE((*writer)->close());
        EXPECT_EQ(read_file(path).events, (std::vector<Event>{{10, 1, 1, 0}}));
    }
}

TEST(DatWriter, says_that_a_disk_is_full) {
    auto writer = create_dat("/dev/full", {64, 32});
    ASSERT_TRUE(writer);
    const auto ok = (*writer)->close();
    ASSERT_FALSE(ok);
    EXPECT_THAT(ok.error().message, HasSubstr("/dev/full: cannot write: No space left on device"));
    EXPECT_FALSE((*writer)->close());
}

TEST(DatWriter, says_where_it_cannot_create) {
    EXPECT_FALSE(create_dat("/nonexistent/a.dat", {64, 32}));
    EXPECT_FALSE(create_dat("/dev/null", {0, 32}));
    EXPECT_FALSE(create_dat("/dev/null", {64, 16385}));
}

TEST(DatWriter, a_real_recording_survives_the_round_trip) {
    PURSUIT_DATA_OR_SKIP(car, "car/car_atis_td.dat");
    const test::TemporaryFolder folder;
    const auto events = read_file(car).events;
    auto writer = create_events(folder.path("b.dat"), {304, 240});
    ASSERT_TRUE(writer);
    ASSERT_TRUE((*writer)->write(events));
    ASSERT_TRUE((*writer)->close());
    EXPECT_EQ((*writer)->events_written(), events.size());
    EXPECT_EQ(read_file(folder.path("b.dat")).events, events);
}

}  // namespace
}  // namespace pursuit::sensor
