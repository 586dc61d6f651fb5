// SPDX-License-Identifier: Apache-2.0
// What every reader promises: events, exposure measurements, time, and bytes as they arrive.
#include "services/sensor/formats/event_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <vector>

#include "services/sensor/formats/byte_source.hpp"
#include "services/sensor/range_reader.hpp"
#include "tests/unit/sensor/chunk_source.hpp"
#include "tests/unit/sensor/read_all.hpp"

namespace pursuit::sensor {
namespace {

/// One step a call of decode().
struct Step {
    std::vector<Event> events;
    std::vector<Event> exposures;
    std::int64_t time_us = 0;
    std::string error = {};
};

class Scripted final : public EventReader {
 public:
    explicit Scripted(std::deque<Step> steps) : steps_(std::move(steps)) {}
    Geometry geometry() const override { return {8, 8}; }
    bool has_exposures() const override { return true; }

 protected:
    Decoded decode(std::span<Event> events, std::span<Event> exposures) override {
        Decoded done;
        if (steps_.empty()) return done;
        const auto step = steps_.front();
        steps_.pop_front();
        std::copy(step.events.begin(), step.events.end(), events.begin());
        done.count = step.events.size();
        if (!exposures.empty()) {
            std::copy(step.exposures.begin(), step.exposures.end(), exposures.begin());
            done.exposures = step.exposures.size();
        }
        done.time_us = step.time_us;
        done.goes_on = true;
        if (!step.error.empty()) done.error = Error{step.error};
        return done;
    }

 private:
    std::deque<Step> steps_;
};

std::deque<Step> some_steps() {
    return {{{{1, 0, 0, 1}}, {{2, 0, 0, 0}}},
            {{}, {{3, 0, 0, 1}}},
            {{}, {}, 9},
            {{{10, 1, 1, 0}, {12, 1, 1, 1}}, {{12, 1, 1, 0}}}};
}

TEST(EventReader, hands_out_exposures_beside_the_events_and_time_without_either) {
    Scripted reader(some_steps());
    std::vector<Event> events(4);
    std::vector<Event> exposures(4);
    auto batch = reader.read(events, exposures);
    EXPECT_EQ(batch->events, 1U);
    EXPECT_EQ(batch->exposures, 1U);
    EXPECT_EQ(reader.time_us(), 2);
    EXPECT_EQ(reader.read(events, exposures)->exposures, 1U);
    EXPECT_EQ(reader.time_us(), 3);
    batch = reader.read(events, exposures);
    EXPECT_EQ(batch->events + batch->exposures, 0U);
    EXPECT_FALSE(batch->at_end);
    EXPECT_EQ(reader.time_us(), 9);
    EXPECT_EQ(reader.read(events, exposures)->events, 2U);
    EXPECT_TRUE(reader.read(events, exposures)->at_end);
    EXPECT_EQ(reader.events_read(), 3U);
    EXPECT_EQ(reader.exposures_read(), 3U);
}

TEST(EventReader, read_for_events_alone_gives_zero_only_at_the_end) {
    Scripted reader(some_steps());
    const auto all = read_all(reader);
    EXPECT_EQ(all.events.size(), 3U);
    EXPECT_EQ(reader.exposures_read(), 0U);
}

TEST(EventReader, an_error_follows_what_came_before_it_even_if_that_is_only_exposures) {
    Scripted reader({{{}, {{3, 0, 0, 1}}, 0, "broken"}});
    std::vector<Event> events(4);
    std::vector<Event> exposures(4);
    EXPECT_EQ(reader.read(events, exposures)->exposures, 1U);
    EXPECT_EQ(reader.read(events, exposures).error().message, "broken");
    EXPECT_EQ(reader.read(events).error().message, "broken");
}

TEST(RangeReader, cuts_exposures_as_it_cuts_events_and_ends_when_time_has_passed) {
    struct Case {
        TimeRange range;
        std::uint64_t events;
        std::uint64_t exposures;
    };
    for (const Case& known : std::vector<Case>{
             {{2, 12}, 1, 2}, {{2, 13}, 2, 3}, {{3, 9}, 0, 1}, {{10, 0}, 2, 1}, {{0, 2}, 1, 0}}) {
        const auto [start_us, end_us] = known.range;
        const auto reader = in_range(std::make_unique<Scripted>(some_steps()), known.range);
        std::vector<Event> events(4);
        std::vector<Event> exposures(4);
        for (;;) {
            const auto batch = reader->read(events, exposures);
            ASSERT_TRUE(batch);
            if (batch->at_end) break;
        }
        EXPECT_EQ(reader->events_read(), known.events) << start_us << " to " << end_us;
        EXPECT_EQ(reader->exposures_read(), known.exposures) << start_us << " to " << end_us;
        EXPECT_TRUE(end_us == 0 || reader->time_us() <= end_us);
    }
}

TEST(RangeReader, tells_no_time_before_it_has_begun) {
    const auto reader = in_range(std::make_unique<Scripted>(some_steps()), {10, 0});
    std::vector<Event> events(4);
    std::vector<Event> exposures(4);
    for (int before = 0; before < 3; ++before) {
        EXPECT_FALSE(reader->read(events, exposures)->at_end);
        EXPECT_EQ(reader->time_us(), 0);
    }
    EXPECT_EQ(reader->read(events, exposures)->events, 2U);
    EXPECT_EQ(reader->time_us(), 12);
}

std::string text_of(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(ByteWindow, waits_for_no_more_than_it_is_asked_for) {
    ByteWindow window(
        std::make_unique<ChunkSource>("a", std::deque<std::string>{"ab", "cd", "ef\ngh"}, false));
    EXPECT_EQ(text_of(*window.ahead(1)), "ab");
    EXPECT_EQ(text_of(*window.ahead(2)), "ab");
    EXPECT_EQ(text_of(*window.ahead(3)), "abcd");
    window.consume(3);
    EXPECT_EQ(*window.line(100), "def\n");
    window.consume(4);
    EXPECT_EQ(window.offset(), 7U);
    EXPECT_EQ(text_of(window.at_hand()), "gh");
    EXPECT_EQ(window.ahead(3).error().message, "waited");
}

TEST(ByteWindow, a_line_is_cut_where_it_is_too_long_and_the_last_may_lack_its_end) {
    for (const std::size_t size : {1, 2, 100}) {
        ByteWindow window(ChunkSource::of("a", "12345\n\n67", size), 8);
        EXPECT_EQ(*window.line(4), "1234");
        EXPECT_EQ(*window.line(6), "12345\n");
        window.consume(6);
        EXPECT_EQ(*window.line(6), "\n");
        window.consume(1);
        EXPECT_EQ(*window.line(6), "67");
        window.consume(2);
        EXPECT_EQ(*window.line(6), "");
        EXPECT_EQ(window.offset(), 9U);
    }
}

}  // namespace
}  // namespace pursuit::sensor
