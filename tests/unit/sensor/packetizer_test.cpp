// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/packetizer.hpp"

#include <gtest/gtest.h>

#include <random>

#include "services/sensor/packed_event.hpp"

namespace pursuit::sensor {
namespace {

std::vector<EventBatch> batches_of(const std::vector<Event>& events, Packetizer::Limits limits,
                                   std::size_t at_a_time = 100) {
    Packetizer packetizer(limits);
    std::vector<EventBatch> batches;
    const auto drain = [&] {
        while (const auto* batch = packetizer.next()) batches.push_back(*batch);
    };
    for (std::size_t i = 0; i < events.size(); i += at_a_time) {
        packetizer.push(std::span(events).subspan(i, std::min(at_a_time, events.size() - i)));
        drain();
    }
    packetizer.finish();
    drain();
    return batches;
}

std::vector<Event> events_of(const EventBatch& batch) {
    std::vector<Event> events;
    for (const auto word : batch.words) events.push_back(unpack(word, batch.base_time_us));
    return events;
}

TEST(PackedEvent, has_the_stated_bits) {
    EXPECT_EQ(pack({0x1'0000'0005, 0x1234, 0x0abc, 1}, 0x1'0000'0000), 0x0000'0005'1234'1579U);
    EXPECT_EQ(pack({7, 0, 0, 0}, 7), 0U);
}

TEST(PackedEvent, unpacks_to_what_was_packed_at_every_limit) {
    const std::vector<std::int64_t> bases = {0, 1'700'000'000'000'000};
    const std::vector<std::int64_t> offsets = {0, 1, 0xffff'ffff};
    const std::vector<std::uint16_t> xs = {0, 1, 0x8000, 0xffff};
    const std::vector<std::uint16_t> ys = {0, 1, 0x7fff};
    const std::vector<std::uint8_t> polarities = {0, 1};
    for (const auto base : bases) {
        for (const auto offset : offsets) {
            for (const auto x : xs) {
                for (const auto y : ys) {
                    for (const auto polarity : polarities) {
                        const Event event{base + offset, x, y, polarity};
                        EXPECT_EQ(unpack(pack(event, base), base), event);
                    }
                }
            }
        }
    }
}

TEST(Packetizer, a_stream_without_events_is_only_its_end) {
    const auto batches = batches_of({}, {});
    ASSERT_EQ(batches.size(), 1U);
    EXPECT_TRUE(batches[0].end_of_stream);
    EXPECT_TRUE(batches[0].words.empty());
    EXPECT_EQ(batches[0].base_time_us, 0);
}

TEST(Packetizer, one_event_makes_one_packet_and_the_end_one_microsecond_later) {
    const auto batches = batches_of({{50, 1, 2, 1}}, {});
    ASSERT_EQ(batches.size(), 2U);
    EXPECT_EQ(batches[0].base_time_us, 50);
    EXPECT_EQ(events_of(batches[0]), (std::vector<Event>{{50, 1, 2, 1}}));
    EXPECT_FALSE(batches[0].end_of_stream);
    EXPECT_TRUE(batches[1].end_of_stream);
    EXPECT_EQ(batches[1].base_time_us, 51);
}

TEST(Packetizer, cut_short_gives_what_it_was_filling_and_the_end_and_tells_how_much_is_left) {
    Packetizer packetizer({2, 1000});
    const std::vector<Event> events = {{5, 1, 1, 1}, {6, 1, 1, 1}, {7, 1, 1, 1}, {8, 1, 1, 1}};
    packetizer.push(events);
    packetizer.advance(90'000);
    ASSERT_NE(packetizer.next(), nullptr);
    EXPECT_EQ(packetizer.cut(), 2U);
    EXPECT_EQ(packetizer.next(), nullptr);
    packetizer.push(std::span(events).last(1));
    EXPECT_EQ(packetizer.next(), nullptr);
    packetizer.finish();
    EXPECT_EQ(events_of(*packetizer.next()), (std::vector<Event>{events.back()}));
    const auto* end = packetizer.next();
    ASSERT_NE(end, nullptr);
    EXPECT_TRUE(end->end_of_stream);
    EXPECT_EQ(end->base_time_us, 9);
    EXPECT_EQ(packetizer.next(), nullptr);
}

TEST(Packetizer, closes_by_count_even_within_one_microsecond) {
    const auto batches = batches_of(std::vector<Event>(5, {9, 0, 0, 0}), {2, 1000});
    ASSERT_EQ(batches.size(), 4U);
    EXPECT_EQ(batches[0].words.size(), 2U);
    EXPECT_EQ(batches[1].words.size(), 2U);
    EXPECT_EQ(batches[2].words.size(), 1U);
    EXPECT_EQ(batches[0].complete_us, 9);
}

TEST(Packetizer, closes_by_time_before_the_event_that_is_too_late) {
    const auto batches =
        batches_of({{100, 0, 0, 0}, {1099, 0, 0, 0}, {1100, 0, 0, 0}}, {100, 1000});
    ASSERT_EQ(batches.size(), 3U);
    EXPECT_EQ(batches[0].words.size(), 2U);
    EXPECT_EQ(batches[0].complete_us, 1100);
    EXPECT_EQ(batches[1].base_time_us, 1100);
}

TEST(Packetizer, keeps_time_going_through_silence) {
    const auto batches = batches_of({{0, 0, 0, 0}, {65'000, 0, 0, 0}}, {100, 1000});
    ASSERT_EQ(batches.size(), 6U);
    for (int i = 1; i <= 3; ++i) {
        EXPECT_TRUE(batches[i].words.empty());
        EXPECT_EQ(batches[i].base_time_us, 20'000 * i);
        EXPECT_EQ(batches[i].complete_us, 20'000 * i);
        EXPECT_FALSE(batches[i].end_of_stream);
    }
    EXPECT_EQ(batches[4].base_time_us, 65'000);
}

TEST(Packetizer, needs_no_empty_packet_where_the_next_event_comes_in_20_ms) {
    EXPECT_EQ(batches_of({{0, 0, 0, 0}, {20'000, 0, 0, 0}}, {100, 1000}).size(), 3U);
}

TEST(Packetizer, a_stream_cut_short_still_ends_after_what_was_sent) {
    Packetizer packetizer({1, 1000});
    const std::vector<Event> events = {{5, 0, 0, 0}, {6, 0, 0, 0}};
    packetizer.push(events);
    ASSERT_NE(packetizer.next(), nullptr);
    packetizer.push({});
    packetizer.finish();
    const auto* end = packetizer.next();
    ASSERT_NE(end, nullptr);
    EXPECT_TRUE(end->end_of_stream);
    EXPECT_EQ(end->base_time_us, 6);
    EXPECT_EQ(packetizer.next(), nullptr);
}

TEST(Packetizer, loses_and_reorders_nothing_and_keeps_every_rule_on_random_streams) {
    std::mt19937 random(3);
    for (int round = 0; round < 40; ++round) {
        std::vector<Event> events;
        std::int64_t t_us = random() % 1'000'000;
        for (int i = 0; i < 3000; ++i) {
            const auto kind = random() % 100;
            t_us += kind == 0 ? random() % 90'000 : kind < 10 ? random() % 900 : random() % 3;
            events.push_back({t_us, static_cast<std::uint16_t>(random() % 640),
                              static_cast<std::uint16_t>(random() % 480),
                              static_cast<std::uint8_t>(random() % 2)});
        }
        const Packetizer::Limits limits{static_cast<std::uint32_t>(1 + random() % 200),
                                        static_cast<std::uint32_t>(50 + random() % 19'950)};
        const auto batches = batches_of(events, limits, 1 + random() % 500);
        EXPECT_EQ(batches, batches_of(events, limits, 3000));

        std::vector<Event> sent;
        std::int64_t told_us = events.front().t_us;
        for (const auto& batch : batches) {
            EXPECT_LE(batch.base_time_us, told_us + Packetizer::silence_us);
            EXPECT_GE(batch.base_time_us, told_us);
            EXPECT_EQ(batch.end_of_stream, &batch == &batches.back());
            EXPECT_LE(batch.words.size(), limits.packet_events);
            told_us = batch.base_time_us;
            for (const auto& event : events_of(batch)) {
                EXPECT_LT(event.t_us, batch.base_time_us + limits.packet_us);
                EXPECT_LE(event.t_us, batch.complete_us);
                told_us = event.t_us;
                sent.push_back(event);
            }
        }
        EXPECT_EQ(sent, events);
        EXPECT_EQ(batches.back().base_time_us, events.back().t_us + 1);
    }
}

std::vector<EventBatch> drained(Packetizer& packetizer) {
    std::vector<EventBatch> batches;
    while (const auto* batch = packetizer.next()) batches.push_back(*batch);
    return batches;
}

TEST(Packetizer, time_that_passes_without_events_closes_the_batch_and_is_told_every_20_ms) {
    Packetizer packetizer({4096, 1000});
    const std::vector<Event> events{{100, 1, 1, 1}};
    packetizer.push(events);
    packetizer.advance(1099);
    EXPECT_TRUE(drained(packetizer).empty());
    packetizer.advance(1100);
    const auto closed = drained(packetizer);
    ASSERT_EQ(closed.size(), 1U);
    EXPECT_EQ(closed[0].words.size(), 1U);
    EXPECT_EQ(closed[0].complete_us, 1100);
    packetizer.advance(60'099);
    const auto silence = drained(packetizer);
    ASSERT_EQ(silence.size(), 2U);
    EXPECT_EQ(silence[0].base_time_us, 20'100);
    EXPECT_EQ(silence[1].base_time_us, 40'100);
    EXPECT_TRUE(silence[1].words.empty());
    packetizer.advance(50'000);  // time does not go back
    const std::vector<Event> next{{60'099, 2, 2, 0}};
    packetizer.push(next);
    packetizer.finish();
    const auto rest = drained(packetizer);
    ASSERT_EQ(rest.size(), 2U);
    EXPECT_EQ(rest[0].base_time_us, 60'099);
    EXPECT_EQ(rest[1].base_time_us, 60'100);
    EXPECT_TRUE(rest[1].end_of_stream);
}

TEST(Packetizer, time_before_the_first_event_is_told_too_and_the_end_is_not_before_it) {
    Packetizer packetizer({4096, 1000});
    packetizer.advance(5'000'000);
    packetizer.advance(5'030'000);
    const auto silence = drained(packetizer);
    ASSERT_EQ(silence.size(), 1U);
    EXPECT_EQ(silence[0].base_time_us, 5'030'000);
    packetizer.finish();
    const auto end = drained(packetizer);
    ASSERT_EQ(end.size(), 1U);
    EXPECT_EQ(end[0].base_time_us, 5'030'000);
    EXPECT_TRUE(end[0].end_of_stream);
}

TEST(Packetizer, a_flush_closes_what_is_there_and_nothing_else) {
    Packetizer packetizer({4096, 1000});
    packetizer.flush();
    EXPECT_TRUE(drained(packetizer).empty());
    const std::vector<Event> events{{100, 1, 1, 1}, {150, 1, 1, 0}};
    packetizer.push(events);
    EXPECT_TRUE(drained(packetizer).empty());
    packetizer.flush();
    const auto closed = drained(packetizer);
    ASSERT_EQ(closed.size(), 1U);
    EXPECT_EQ(events_of(closed[0]), events);
    EXPECT_EQ(closed[0].complete_us, 150);
    const std::vector<Event> next{{150, 2, 2, 1}};
    packetizer.push(next);
    EXPECT_TRUE(drained(packetizer).empty());
}

}  // namespace
}  // namespace pursuit::sensor
