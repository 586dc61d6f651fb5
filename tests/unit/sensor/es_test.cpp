// SPDX-License-Identifier: Apache-2.0
// Event Stream, read and written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "services/sensor/formats/es_writer.hpp"
#include "services/sensor/formats/formats.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_data.hpp"
#include "tests/unit/sensor/read_all.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;
using Events = std::vector<Event>;

enum Type : char { dvs = 1, atis = 2 };

std::string es_header(char type, std::uint16_t width = 64, std::uint16_t height = 32) {
    std::string header("Event Stream\x02\0\0", 15);
    header += type;
    return header + little_endian(width) + little_endian(height);
}

std::string event(unsigned first, std::uint16_t x, std::uint16_t y_up) {
    return static_cast<char>(first) + little_endian(x) + little_endian(y_up);
}

ReadAll decode_es(const std::string& bytes, std::size_t at_a_time = 1000) {
    return decode_bytes("a.es", bytes, {}, at_a_time);
}

TEST(EsReader, reads_dvs_events_with_y_upwards_and_time_in_steps) {
    const auto all = decode_es(es_header(dvs) + event(0, 0, 0) + event(5 << 1 | 1, 63, 31) +
                               "\xff\xfe\xff" + event(126 << 1, 1, 2));
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(all.events, (Events{{0, 0, 31, 0}, {5, 63, 0, 1}, {385, 1, 29, 0}}));
    EXPECT_TRUE(all.exposures.empty());
}

TEST(EsReader, reads_atis_events_apart_from_exposure_measurements) {
    const auto bytes = es_header(atis) + event(1 << 2 | 2, 3, 0) + event(2 << 2 | 1, 4, 0) +
                       "\xff\xfd\xfc" + event(62 << 2 | 3, 4, 0) + event(0, 5, 31);
    const auto all = decode_es(bytes);
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(all.events, (Events{{1, 3, 31, 1}, {317, 5, 0, 0}}));
    EXPECT_EQ(all.exposures, (Events{{3, 4, 31, 0}, {317, 4, 31, 1}}));
    auto reader = open_events(
        from_memory("a.es", {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
    EXPECT_TRUE((*reader)->has_exposures());
    EXPECT_EQ(read_all(**reader, 1).events, all.events);
}

TEST(EsReader, names_the_byte_and_cause_of_what_is_wrong_in_a_header) {
    EXPECT_EQ(decode_es("Event Streem").error,
              "a.es: byte 0: does not begin with \"Event Stream\"");
    EXPECT_EQ(decode_es("Event").error, "a.es: byte 0: does not begin with \"Event Stream\"");
    EXPECT_EQ(decode_es("Event Stream\x02").error, "a.es: byte 13: the file ends in its header");
    EXPECT_EQ(decode_es(std::string("Event Stream\x01\x02\0", 15) + "\1abcd").error,
              "a.es: byte 12: version 1.2 of Event Stream is not read, only 2");
    EXPECT_EQ(decode_es(es_header(4)).error,
              "a.es: byte 15: a stream of type 4 holds neither DVS (1) nor ATIS events (2)");
    EXPECT_EQ(decode_es(es_header(dvs, 0, 5)).error, "a.es: byte 16: the header states 0x5 pixels");
}

TEST(EsReader, a_header_alone_is_an_empty_recording) {
    EXPECT_EQ(decode_es(es_header(atis)).error, "");
    EXPECT_TRUE(decode_es(es_header(atis)).events.empty());
}

TEST(EsReader, delivers_the_good_events_before_a_bad_one) {
    const auto good = es_header(dvs) + event(2, 1, 1);
    for (const auto& [bad, cause] : std::vector<std::pair<std::string, std::string>>{
             {event(2, 64, 1), "byte 25: pixel (64, 1) is outside 64x32 (y upwards)"},
             {event(2, 1, 32), "byte 25: pixel (1, 32) is outside 64x32 (y upwards)"},
             {"\xff" + event(2, 1, 1).substr(0, 3),
              "byte 26: the file ends within an event, after 3 of 5 bytes"}}) {
        const auto all = decode_es(good + bad);
        EXPECT_EQ(all.events, (Events{{1, 1, 30, 0}}));
        EXPECT_EQ(all.error, "a.es: " + cause);
    }
}

/// The state machine of the specification, byte by byte.
ReadAll reference(const std::string& bytes, char type) {
    ReadAll all;
    std::int64_t t_us = 0;
    for (std::size_t i = 20; i < bytes.size();) {
        const auto first = static_cast<unsigned char>(bytes[i]);
        if (type == dvs && first >= 0xfe) {
            t_us += first == 0xff ? 127 : 0;
            ++i;
            continue;
        }
        if (type == atis && (first & 0xfc) == 0xfc) {
            t_us += 63 * (first & 3);
            ++i;
            continue;
        }
        if (i + 5 > bytes.size()) {
            all.error = "truncated";
            return all;
        }
        const auto byte = [&](std::size_t k) {
            return static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k]));
        };
        const auto x = byte(1) | byte(2) << 8;
        const auto y = byte(3) | byte(4) << 8;
        if (x >= 64 || y >= 32) {
            all.error = "outside";
            return all;
        }
        t_us += type == dvs ? first >> 1 : first >> 2;
        const auto polarity = type == dvs ? first & 1 : first >> 1 & 1;
        const bool is_exposure = type == atis && (first & 1) == 1;
        (is_exposure ? all.exposures : all.events)
            .push_back({t_us, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(31 - y),
                        static_cast<std::uint8_t>(polarity)});
        i += 5;
    }
    return all;
}

TEST(EsReader, agrees_with_the_state_machine_on_random_streams_however_they_arrive) {
    std::mt19937 random(1);
    const auto below = [&](unsigned n) { return static_cast<unsigned>(random() % n); };
    for (int round = 0; round < 80; ++round) {
        const char type = round % 2 == 0 ? dvs : atis;
        auto bytes = es_header(type);
        const auto count = below(2000);
        const auto bad = below(2) == 0 ? below(3000) : 3000;
        for (unsigned i = 0; i < count; ++i) {
            while (below(8) == 0) {
                bytes += static_cast<char>(type == dvs ? 0xfe + below(2) : 0xfc + below(4));
            }
            bytes += event(below(type == dvs ? 0xfe : 0xfc), static_cast<std::uint16_t>(below(64)),
                           static_cast<std::uint16_t>(i == bad ? 32 : below(32)));
        }
        if (below(3) == 0) bytes.resize(bytes.size() - std::min(below(5), 4 * count));
        const auto expected = reference(bytes, type);
        for (const auto& all : {decode_es(bytes, 1 + below(300)),
                                decode_chunks("a.es", bytes, 1 + below(40), {}, 1 + below(300))}) {
            EXPECT_EQ(all.events, expected.events);
            EXPECT_EQ(all.exposures, expected.exposures);
            EXPECT_EQ(all.error.empty(), expected.error.empty()) << all.error;
        }
    }
}

TEST(EsReader, on_a_live_stream_holds_back_no_event_that_has_arrived) {
    ReadOptions options;
    options.format = "es";
    auto reader = open_events(std::make_unique<ChunkSource>(
                                  "live",
                                  std::deque<std::string>{es_header(dvs), event(2, 1, 1) + "\xff",
                                                          event(4, 2, 2) + "\x02\x03"},
                                  false),
                              options);
    ASSERT_TRUE(reader);
    std::vector<Event> events(10);
    EXPECT_EQ((*reader)->read(events, {})->events, 1U);
    EXPECT_EQ((*reader)->time_us(), 128);
    EXPECT_EQ((*reader)->read(events, {})->events, 1U);
    EXPECT_EQ((*reader)->time_us(), 130);
    EXPECT_EQ((*reader)->read(events, {}).error().message, "waited");
}

TEST(EsWriter, what_it_writes_is_read_back_unchanged) {
    std::mt19937 random(2);
    const auto below = [&](unsigned n) { return static_cast<unsigned>(random() % n); };
    for (const bool with_exposures : {false, true}) {
        const test::TemporaryFolder folder;
        const auto path = folder.path("a.es");
        auto writer = create_events(path, {640, 480}, with_exposures);
        ASSERT_TRUE(writer);
        EXPECT_EQ((*writer)->holds_exposures(), with_exposures);
        Events events;
        Events exposures;
        std::int64_t t_us = 0;
        for (int block = 0; block < 20; ++block) {
            const auto events_before = events.size();
            const auto exposures_before = exposures.size();
            for (unsigned i = below(200); i > 0; --i) {
                const unsigned longest[] = {1, 70, 130, 1000};
                t_us += below(longest[below(4)]);
                const Event one{t_us, static_cast<std::uint16_t>(below(640)),
                                static_cast<std::uint16_t>(below(480)),
                                static_cast<std::uint8_t>(below(2))};
                (with_exposures && below(2) == 0 ? exposures : events).push_back(one);
            }
            ASSERT_TRUE((*writer)->write(std::span(events).subspan(events_before),
                                         std::span(exposures).subspan(exposures_before)));
        }
        ASSERT_TRUE((*writer)->close());
        EXPECT_EQ((*writer)->exposures_written(), exposures.size());
        const auto all = decode_es(test::content_of(path), 100);
        EXPECT_EQ(all.error, "");
        EXPECT_EQ(all.events, events);
        EXPECT_EQ(all.exposures, exposures);
    }
}

TEST(EsWriter, refuses_what_it_cannot_hold_and_keeps_what_was_before) {
    const test::TemporaryFolder folder;
    const auto path = folder.path("a.es");
    auto writer = create_es(path, {64, 32}, true);
    const Events events = {{10, 1, 1, 0}, {11, 1, 1, 0}};
    const Events exposures = {{9, 1, 1, 0}, {12, 1, 1, 2}};
    EXPECT_EQ((*writer)->write(events, exposures).error().message,
              path + ": exposure 1: polarity 2 is not 0 or 1");
    EXPECT_THAT((*writer)->write(Events{{9, 1, 1, 0}}).error().message,
                HasSubstr("event 2: time goes back from 11 to 9 us"));
    EXPECT_THAT(
        (*writer)->write({}, Events{{11 + (std::int64_t{1} << 32), 1, 1, 0}}).error().message,
        HasSubstr("cannot hold the step of time from 11 to 4294967307 us"));
    ASSERT_TRUE((*writer)->close());
    const auto all = decode_es(test::content_of(path));
    EXPECT_EQ(all.events, events);
    EXPECT_EQ(all.exposures, (Events{{9, 1, 1, 0}}));
    EXPECT_FALSE(create_es("/dev/null", {0, 1}));
    EXPECT_FALSE(create_es("/nonexistent/a.es", {1, 1}));
}

TEST(EsWriter, a_file_of_events_alone_refuses_exposures) {
    const test::TemporaryFolder folder;
    auto writer = create_es(folder.path("a.es"), {64, 32});
    EXPECT_THAT((*writer)->write({}, Events{{1, 1, 1, 1}}).error().message,
                HasSubstr("holds no exposure measurements"));
}

TEST(EsReader, the_real_atis_recording_has_its_exposures_and_survives_a_round_trip) {
    PURSUIT_DATA_OR_SKIP(car, "car/car_atis_td_em.es");
    const auto all = decode_es(test::content_of(car));
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(all.events.size(), 242'040U);
    EXPECT_EQ(all.exposures.size(), 442'382U);
    const test::TemporaryFolder folder;
    auto writer = create_events(folder.path("b.es"), {304, 240}, true);
    ASSERT_TRUE((*writer)->write(all.events, all.exposures));
    ASSERT_TRUE((*writer)->close());
    const auto again = decode_es(test::content_of(folder.path("b.es")));
    EXPECT_EQ(again.events, all.events);
    EXPECT_EQ(again.exposures, all.exposures);
}

}  // namespace
}  // namespace pursuit::sensor
