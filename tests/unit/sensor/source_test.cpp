// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "services/sensor/formats/formats.hpp"
#include "services/sensor/range_reader.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/sensor/read_all.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;

disk::SensorConfig recording_of(const test::TemporaryFolder& folder) {
    std::string text;
    for (int i = 0; i < 100; ++i) text += "0." + std::to_string(100 + i) + " 1 1 1\n";
    disk::SensorConfig config;
    config.set_recording(folder.file("a.txt", text));
    return config;
}

std::vector<std::int64_t> times_of(const disk::SensorConfig& config, std::size_t at_a_time) {
    auto source = open_source(config);
    std::vector<std::int64_t> times;
    for (const auto& event : read_all(**source, at_a_time).events) times.push_back(event.t_us);
    return times;
}

TEST(OpenSource, gives_a_recording_whole_and_from_its_start_each_time) {
    const test::TemporaryFolder folder;
    const auto config = recording_of(folder);
    EXPECT_EQ(times_of(config, 7).size(), 100U);
    EXPECT_EQ(times_of(config, 1000).size(), 100U);
    EXPECT_EQ((*open_source(config))->geometry(), (Geometry{240, 180}));
}

TEST(OpenSource, cuts_the_range_with_its_start_and_without_its_end) {
    const test::TemporaryFolder folder;
    auto config = recording_of(folder);
    config.set_start_s(0.120);
    config.set_end_s(0.130);
    for (const std::size_t at_a_time : {1, 3, 1000}) {
        const auto times = times_of(config, at_a_time);
        ASSERT_EQ(times.size(), 10U);
        EXPECT_EQ(times.front(), 120'000);
        EXPECT_EQ(times.back(), 129'000);
    }
    config.set_end_s(0);
    EXPECT_EQ(times_of(config, 3).size(), 80U);
    config.set_start_s(9);
    EXPECT_TRUE(times_of(config, 3).empty());
}

TEST(OpenSource, an_error_after_the_range_does_not_matter_and_one_before_its_end_does) {
    const test::TemporaryFolder folder;
    disk::SensorConfig config;
    config.set_recording(folder.file("a.txt", "0.1 1 1 1\n0.2 1 1 1\n0.3 1 1 1\nbad\n"));
    config.set_end_s(0.25);
    EXPECT_EQ(read_all(**open_source(config), 2).error, "");
    config.set_end_s(0.4);
    const auto all = read_all(**open_source(config), 2);
    EXPECT_EQ(all.events.size(), 3U);
    EXPECT_THAT(all.error, HasSubstr("line 4"));
}

TEST(OpenSource, does_not_wait_for_the_writer_of_a_fifo_but_names_what_does) {
    const test::TemporaryFolder folder;
    const auto fifo = folder.path("camera.dat");
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    disk::SensorConfig config;
    config.set_recording(fifo);
    EXPECT_EQ(open_source(config).error().message,
              "field recording: " + fifo +
                  " is not a regular file; a FIFO or a device is heard with live");
    config.clear_recording();
    config.set_scene(fifo);
    EXPECT_EQ(open_source(config).error().message,
              "field scene: " + fifo + ": is not a regular file");
    config.set_scene(folder.path(""));
    EXPECT_THAT(open_source(config).error().message, HasSubstr("is a folder"));
}

TEST(OpenSource, needs_exactly_one_source_and_a_range_that_holds_time) {
    disk::SensorConfig config;
    EXPECT_FALSE(open_source(config));
    config.set_recording("a");
    config.set_scene("b");
    EXPECT_FALSE(open_source(config));
    config.clear_scene();
    config.set_start_s(2);
    config.set_end_s(2);
    EXPECT_THAT(open_source(config).error().message,
                HasSubstr("end_s: a range must end after it begins"));
    config.set_end_s(1e300);
    EXPECT_THAT(open_source(config).error().message, HasSubstr("0 to 9e12 s"));
}

TEST(LiveOptions, are_judged_beside_a_scene_too) {
    disk::SensorConfig config;
    config.set_scene("overtake");
    EXPECT_TRUE(live_options(config));
    config.set_live_geometry("wide");
    EXPECT_EQ(live_options(config).error().field, "live_geometry");
    config.set_live_geometry("640x480");
    config.set_live_format("no_such");
    EXPECT_EQ(live_options(config).error().field, "live_format");
}

}  // namespace
}  // namespace pursuit::sensor
