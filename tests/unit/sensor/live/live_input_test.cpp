// SPDX-License-Identifier: Apache-2.0
// Live sources without a network: pipes, and a driver in a library of its own.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include "services/sensor/live/byte_stream_input.hpp"
#include "services/sensor/live/driver_input.hpp"
#include "services/sensor/source.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pursuit::sensor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Kind = LiveItem::Kind;
using namespace std::chrono_literals;

/// An input on a thread of its own, as a publisher runs it.
class Heard {
 public:
    explicit Heard(std::unique_ptr<LiveInput> input)
        : input_(std::move(input)), thread_([this] {
              input_->run(sink, stop);
              sink.queue().close();
          }) {}
    ~Heard() {
        stop.raise();
        thread_.join();
    }
    Heard(const Heard&) = delete;
    Heard& operator=(const Heard&) = delete;

    /// The next item; the test fails where none comes within 5 s.
    LiveItem next() {
        LiveItem item;
        EXPECT_TRUE(sink.queue().take(item, 5s));
        return item;
    }

    /// The next stream, from its begin to its end.
    struct Stream {
        Geometry geometry;
        std::vector<Event> events;
        std::string fault;
    };
    Stream stream() {
        Stream whole;
        auto item = next();
        EXPECT_EQ(item.kind, Kind::begin);
        whole.geometry = item.geometry;
        for (item = next(); item.kind == Kind::events; item = next()) {
            whole.events.insert(whole.events.end(), item.events.begin(), item.events.end());
        }
        EXPECT_EQ(item.kind, Kind::end);
        whole.fault = item.fault;
        return whole;
    }

    SystemClock clock;
    LiveSink sink{100'000, clock};
    StopSignal stop;

 private:
    std::unique_ptr<LiveInput> input_;
    std::thread thread_;
};

TEST(LiveAddress, is_standard_input_a_path_or_a_host_and_a_port) {
    EXPECT_EQ(parse_live_address("-")->kind, LiveAddress::Kind::standard_input);
    EXPECT_EQ(parse_live_address("/dev/camera0")->kind, LiveAddress::Kind::path);
    const auto tcp = parse_live_address("tcp://camera.local:7000");
    ASSERT_TRUE(tcp);
    EXPECT_EQ(tcp->host, "camera.local");
    EXPECT_EQ(tcp->port, "7000");
    EXPECT_EQ(parse_live_address("tcp://[::1]:80")->host, "::1");
    for (const char* bad : {"tcp://", "tcp://a", "tcp://a:", "tcp://:1", "tcp://a:0",
                            "tcp://a:65536", "tcp://a:1x", "udp://a:1"}) {
        EXPECT_FALSE(parse_live_address(bad)) << bad;
    }
}

TEST(BackOff, doubles_up_to_its_longest_and_begins_again_after_a_stream_that_lasted) {
    BackOff back_off(70ms);
    EXPECT_EQ(back_off.next(), 10ms);
    EXPECT_EQ(back_off.next(), 20ms);
    EXPECT_EQ(back_off.next(), 40ms);
    EXPECT_EQ(back_off.next(), 70ms);
    EXPECT_EQ(back_off.next(), 70ms);
    back_off.heard(69ms);
    EXPECT_EQ(back_off.next(), 70ms);
    back_off.heard(70ms);
    EXPECT_EQ(back_off.next(), 10ms);
}

TEST(LiveSink, says_how_long_the_streams_lasted_since_it_was_asked) {
    pursuit::test::ManualClock clock(1'000'000'000);
    LiveSink sink(100, clock);
    sink.end("nothing had begun");
    EXPECT_EQ(sink.take_lasted(), 0ms);
    for (int i = 0; i < 2; ++i) {
        sink.begin({640, 480});
        clock.advance(30'000'000);
        sink.end("");
        clock.advance(500'000'000);
    }
    EXPECT_EQ(sink.take_lasted(), 60ms);
    EXPECT_EQ(sink.take_lasted(), 0ms);
}

/// Words of EVT2: a time, then one event at it.
std::string evt2(std::uint32_t t_us, std::uint32_t x, std::uint32_t y) {
    const std::uint32_t words[] = {8U << 28 | t_us >> 6,
                                   1U << 28 | (t_us & 63) << 22 | x << 11 | y};
    return {reinterpret_cast<const char*>(words), sizeof words};
}

void write_to(const std::string& fifo, const std::string& bytes) {
    const int file = ::open(fifo.c_str(), O_WRONLY);
    ASSERT_GE(file, 0);
    ASSERT_EQ(::write(file, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    ::close(file);
}

std::unique_ptr<LiveInput> input_of(const std::string& path, const std::string& format = "evt2") {
    disk::SensorConfig config;
    config.set_live(path);
    config.set_live_format(format);
    config.set_live_geometry("640x480");
    auto input = open_live(config);
    EXPECT_TRUE(input) << input.error().message;
    return std::move(*input);
}

TEST(ByteStreamInput, each_writer_of_a_fifo_is_a_stream_and_one_cut_within_a_word_is_a_fault) {
    const test::TemporaryFolder folder;
    const auto fifo = folder.path("camera");
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    Heard heard(input_of(fifo));
    write_to(fifo, evt2(1'000'000, 3, 4) + evt2(1'000'100, 5, 6));
    const auto first = heard.stream();
    EXPECT_EQ(first.geometry, (Geometry{640, 480}));
    EXPECT_THAT(first.events, ElementsAre(Event{1'000'000, 3, 4, 1}, Event{1'000'100, 5, 6, 1}));
    EXPECT_EQ(first.fault, "");
    // Time begins again: another stream.
    write_to(fifo, evt2(64, 7, 8) + "ab");
    const auto second = heard.stream();
    EXPECT_THAT(second.events, ElementsAre(Event{64, 7, 8, 1}));
    EXPECT_THAT(second.fault, HasSubstr(fifo + ": byte 8: "));
}

TEST(ByteStreamInput, counts_events_before_the_first_word_of_time_and_goes_on) {
    const test::TemporaryFolder folder;
    const auto fifo = folder.path("camera");
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    Heard heard(input_of(fifo));
    write_to(fifo, evt2(0, 1, 1).substr(4) + evt2(640, 2, 2));
    EXPECT_THAT(heard.stream().events, ElementsAre(Event{640, 2, 2, 1}));
    EXPECT_EQ(heard.sink.unusable(), 1U);
}

TEST(ByteStreamInput, counts_events_without_a_time_in_the_bytes_that_make_no_sense_too) {
    const test::TemporaryFolder folder;
    const auto fifo = folder.path("camera");
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    Heard heard(input_of(fifo));
    write_to(fifo, evt2(0, 1, 1).substr(4) + std::string("\xff\xff\xff\x5f"));
    EXPECT_THAT(heard.stream().fault, HasSubstr("byte 4: "));
    EXPECT_EQ(heard.sink.unusable(), 1U);
}

TEST(ByteStreamInput, bytes_that_make_no_header_are_a_fault) {
    const test::TemporaryFolder folder;
    for (const auto& [format, bytes, cause] :
         std::vector<std::tuple<std::string, std::string, std::string>>{
             {"es", "no header of Event Stream", "byte 0: "},
             {"raw", "% Date 1\nx", "byte 9: the header ends without a line"},
             {"aedat2", "x", "byte 0: does not begin with"},
             {"aedat4", "x", "byte 0: does not begin with"},
             {"csv", "a,b\n", "must name the columns"},
             {"dat", "% Width 30", "byte 0: a header line does not end"}}) {
        const auto fifo = folder.path(format);
        ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
        Heard heard(input_of(fifo, format));
        write_to(fifo, bytes);
        const auto item = heard.next();
        EXPECT_EQ(item.kind, Kind::end) << format;
        EXPECT_THAT(item.fault, HasSubstr(fifo + ": byte "));
        EXPECT_THAT(item.fault, HasSubstr(cause));
        EXPECT_EQ(heard.sink.faults(), 1U) << format;
    }
}

TEST(ByteStreamInput, a_source_that_ends_before_its_first_byte_is_waited_for_and_no_fault) {
    Heard heard(input_of("/dev/null"));
    while (heard.sink.waits_for().find("is empty") == std::string::npos) {
        std::this_thread::yield();
    }
    EXPECT_EQ(heard.sink.faults(), 0U);
}

TEST(ByteStreamInput, waits_for_a_path_that_is_not_there_yet_and_says_so) {
    const test::TemporaryFolder folder;
    const auto fifo = folder.path("camera");
    Heard heard(input_of(fifo));
    while (heard.sink.waits_for().find("No such file") == std::string::npos) {
        std::this_thread::yield();
    }
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    write_to(fifo, evt2(640, 2, 2));
    EXPECT_EQ(heard.next().kind, Kind::begin);
}

TEST(ByteStreamInput, is_not_of_a_regular_file) {
    const test::TemporaryFolder folder;
    const auto file = folder.file("a.raw", evt2(1, 1, 1));
    const StopSignal stop;
    EXPECT_THAT(connect_live(*parse_live_address(file), stop).error().message,
                HasSubstr("a file of events is a recording"));
}

TEST(OpenLive, refuses_what_is_not_good_by_its_field) {
    disk::SensorConfig config;
    config.set_live("tcp://nowhere");
    EXPECT_THAT(open_live(config).error().message, HasSubstr("field live: "));
    config.set_live("-");
    config.set_live_format("evt9");
    EXPECT_THAT(open_live(config).error().message, HasSubstr("live_format is \"evt9\""));
    config.set_live_format("evt3");
    config.set_live_geometry("640");
    EXPECT_THAT(open_live(config).error().message, HasSubstr("live_geometry is \"640\""));
    config.clear_live();
    config.set_driver("/nowhere/driver.so");
    EXPECT_THAT(open_live(config).error().message, HasSubstr("/nowhere/driver.so"));
    config.set_recording("a.dat");
    EXPECT_FALSE(is_live(config));
    config.clear_recording();
    EXPECT_TRUE(*is_live(config));
    config.set_loop(true);
    EXPECT_THAT(is_live(config).error().message, HasSubstr("loop"));
}

std::unique_ptr<LiveInput> driver_of(const std::string& argument) {
    auto driver = DriverInput::load(PURSUIT_TEST_DRIVER, argument, 20ms);
    EXPECT_TRUE(driver) << driver.error().message;
    EXPECT_EQ((*driver)->name(), "moving dot");
    return std::move(*driver);
}

TEST(DriverInput, hands_over_the_streams_of_a_library_and_ends_with_it) {
    Heard heard(driver_of("events=3"));
    const auto stream = heard.stream();
    EXPECT_EQ(stream.geometry, (Geometry{320, 240}));
    EXPECT_THAT(stream.events,
                ElementsAre(Event{0, 0, 120, 1}, Event{100, 1, 120, 1}, Event{200, 2, 120, 1}));
    EXPECT_EQ(stream.fault, "");
    LiveItem none;
    while (!heard.sink.queue().finished()) std::this_thread::yield();
    EXPECT_FALSE(heard.sink.queue().take(none, 0ms));
}

TEST(DriverInput, leaves_out_and_counts_what_breaks_the_contract_and_begins_again_after_a_fault) {
    Heard heard(driver_of("bad"));
    for (unsigned count = 1; count <= 2; ++count) {
        const auto stream = heard.stream();
        EXPECT_THAT(stream.events, ElementsAre(Event{50, 1, 1, 1}, Event{60, 2, 2, 0}));
        EXPECT_THAT(stream.fault, HasSubstr("moving dot gave up with 7"));
        EXPECT_GE(heard.sink.unusable(), 5 * count);
        EXPECT_GE(heard.sink.lost_before(), 11 * count);
    }
}

TEST(DriverInput, that_begins_a_stream_of_no_size_is_a_fault_which_is_told_once_a_run) {
    Heard heard(driver_of("no size"));
    for (unsigned runs = 1; runs <= 2; ++runs) {
        const auto item = heard.next();
        EXPECT_EQ(item.kind, Kind::end);
        EXPECT_EQ(item.fault,
                  "the driver moving dot begins a stream of 0x240 pixels, must be 1x1 to "
                  "65535x32768");
    }
    EXPECT_GE(heard.sink.unusable(), 1U);
}

TEST(DriverInput, is_stopped_while_it_waits_for_events) {
    Heard heard(driver_of("quiet"));
    EXPECT_EQ(heard.next().kind, Kind::begin);
}

TEST(DriverInput, refuses_a_library_that_is_none) {
    const test::TemporaryFolder folder;
    EXPECT_THAT(DriverInput::load(folder.file("a.so", "x"), "", 20ms).error().message,
                HasSubstr("a.so"));
    EXPECT_THAT(DriverInput::load("libz.so.1", "", 20ms).error().message,
                HasSubstr("has no pursuit_driver_entry()"));
}

}  // namespace
}  // namespace pursuit::sensor
