// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/live/live_queue.hpp"

#include <gtest/gtest.h>

#include <random>

namespace pursuit::sensor {
namespace {

using Kind = LiveItem::Kind;
constexpr std::chrono::milliseconds at_once{0};

/// `count` events, 1 us apart from `first_us` on.
std::vector<Event> run_of(std::size_t count, std::int64_t first_us) {
    std::vector<Event> events;
    for (std::size_t i = 0; i < count; ++i) {
        events.push_back({first_us + static_cast<std::int64_t>(i), 1, 2, 1});
    }
    return events;
}

void push(LiveQueue& queue, std::size_t count, std::int64_t first_us) {
    const auto events = run_of(count, first_us);
    queue.push(events, {}, events.empty() ? first_us : events.back().t_us, 5);
}

TEST(LiveQueue, gives_streams_in_order_and_joins_what_follows_soon) {
    LiveQueue queue(1000);
    LiveItem item;
    EXPECT_FALSE(queue.take(item, at_once));
    queue.begin({4, 3});
    push(queue, 3, 10);
    push(queue, 0, 20);
    push(queue, 2, 30);
    queue.end("it broke");
    queue.close();
    ASSERT_TRUE(queue.take(item, at_once));
    EXPECT_EQ(item.kind, Kind::begin);
    EXPECT_EQ(item.geometry, (Geometry{4, 3}));
    ASSERT_TRUE(queue.take(item, at_once));
    EXPECT_EQ(item.kind, Kind::events);
    ASSERT_EQ(item.events.size(), 5U);
    EXPECT_EQ(item.events[3].t_us, 30);
    EXPECT_EQ(item.reached_us, 31);
    EXPECT_EQ(item.host_ns, 5);
    EXPECT_FALSE(queue.finished());
    ASSERT_TRUE(queue.take(item, at_once));
    EXPECT_EQ(item.kind, Kind::end);
    EXPECT_EQ(item.fault, "it broke");
    EXPECT_TRUE(queue.finished());
    EXPECT_FALSE(queue.take(item, at_once));
}

TEST(LiveQueue, drops_the_oldest_events_when_it_is_full_and_tells_the_next_item) {
    LiveQueue queue(20'000);
    queue.begin({4, 3});
    for (int i = 0; i < 5; ++i) push(queue, 8000, i * 10'000);
    auto totals = queue.totals();
    EXPECT_EQ(totals.dropped_events, 24'000U);
    EXPECT_EQ(totals.waiting, 16'000U);
    EXPECT_EQ(totals.most_waiting, 16'000U);
    LiveItem item;
    ASSERT_TRUE(queue.take(item, at_once));
    EXPECT_EQ(item.kind, Kind::begin);
    ASSERT_TRUE(queue.take(item, at_once));
    EXPECT_EQ(item.events.front().t_us, 30'000);
    EXPECT_EQ(item.dropped_events, 24'000U);
    ASSERT_TRUE(queue.take(item, at_once));
    EXPECT_EQ(item.dropped_events, 0U);
    EXPECT_EQ(queue.totals().waiting, 0U);
}

TEST(LiveQueue, tells_the_end_of_a_stream_what_it_lost_and_the_next_stream_nothing_of_it) {
    LiveQueue queue(8000);
    queue.begin({4, 3});
    push(queue, 8000, 0);
    queue.end("");
    queue.begin({4, 3});
    push(queue, 8000, 0);
    LiveItem item;
    std::vector<std::uint64_t> dropped;
    while (queue.take(item, at_once)) dropped.push_back(item.dropped_events);
    EXPECT_EQ(dropped, (std::vector<std::uint64_t>{0, 8000, 0, 0}));
}

TEST(LiveQueue, counts_exposures_apart_and_bounds_both_together) {
    LiveQueue queue(100);
    const auto events = run_of(60, 0);
    queue.push(events, events, 60, 0);
    queue.push(events, {}, 60, 0);
    const auto totals = queue.totals();
    EXPECT_EQ(totals.dropped_events, 60U);
    EXPECT_EQ(totals.dropped_exposures, 60U);
    LiveItem item;
    ASSERT_TRUE(queue.take(item, at_once));
    EXPECT_EQ(item.events.size(), 60U);
    EXPECT_EQ(item.dropped_events, 60U);
    EXPECT_EQ(item.dropped_exposures, 60U);
}

TEST(LiveQueue, forgets_streams_without_events_when_many_wait) {
    LiveQueue queue(1000);
    for (int i = 0; i < 10'000; ++i) {
        queue.begin({4, 3});
        if (i == 5000) push(queue, 7, 0);
        queue.end("");
    }
    LiveItem item;
    std::size_t items = 0, events = 0;
    bool in_stream = false;
    while (queue.take(item, at_once)) {
        ++items;
        events += item.events.size();
        EXPECT_EQ(in_stream, item.kind != Kind::begin);
        in_stream = item.kind != Kind::end;
    }
    EXPECT_LE(items, 132U);
    EXPECT_EQ(events, 7U);
}

TEST(LiveQueue, forgets_streams_that_hold_only_time_and_no_count_of_what_was_dropped) {
    LiveQueue queue(1000);
    for (int i = 0; i < 10'000; ++i) {
        queue.begin({4, 3});
        if (i % 2 == 0) push(queue, 0, 7);
        if (i % 4 == 0) push(queue, 600, 7);  // the next makes room of them
        if (i % 3 == 0) push(queue, 0, 9);
        queue.end("");
    }
    LiveItem item;
    std::size_t items = 0;
    std::uint64_t events = 0, told = 0;
    bool in_stream = false;
    while (queue.take(item, at_once)) {
        ++items;
        events += item.events.size();
        told += item.dropped_events;
        if (item.kind == Kind::begin) in_stream = true;
        EXPECT_TRUE(in_stream || item.events.empty());
        if (item.kind == Kind::end) in_stream = false;
    }
    EXPECT_LE(items, 135U);
    EXPECT_EQ(told, queue.totals().dropped_events);
    EXPECT_EQ(events + told, 2500U * 600);
}

TEST(LiveQueue, forgets_faults_of_streams_that_never_began_when_many_wait) {
    LiveQueue queue(1000);
    for (int i = 0; i < 10'000; ++i) queue.end("no size");
    LiveItem item;
    std::size_t items = 0;
    while (queue.take(item, at_once)) ++items;
    EXPECT_GE(items, 1U);
    EXPECT_LE(items, 132U);
}

TEST(LiveQueue, loses_nothing_uncounted_on_random_traffic) {
    std::mt19937 random(5);
    LiveQueue queue(30'000);
    std::uint64_t in = 0, out = 0, told = 0;
    std::int64_t last_us = -1;
    LiveItem item;
    for (int i = 0; i < 3000; ++i) {
        const auto count = random() % 3000;
        push(queue, count, i * 10'000);
        in += count;
        if (random() % 3 != 0) continue;
        ASSERT_TRUE(queue.take(item, at_once));
        out += item.events.size();
        told += item.dropped_events;
        if (item.events.empty()) continue;
        EXPECT_GT(item.events.front().t_us, last_us);
        last_us = item.events.back().t_us;
        EXPECT_LE(queue.totals().waiting, 30'000U);
    }
    while (queue.take(item, at_once)) {
        out += item.events.size();
        told += item.dropped_events;
    }
    EXPECT_EQ(in, out + told);
    EXPECT_EQ(told, queue.totals().dropped_events);
    EXPECT_GT(told, 0U);
}

}  // namespace
}  // namespace pursuit::sensor
