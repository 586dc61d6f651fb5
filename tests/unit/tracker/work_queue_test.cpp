// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/work_queue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <thread>

namespace pursuit::tracker {
namespace {

using Queue = WorkQueue<int, std::string>;

std::string next(Queue& queue) {
    const auto work = queue.pop();
    if (!work) return "nothing";
    if (const auto* packet = std::get_if<int>(&*work)) return std::to_string(*packet);
    return std::get<std::string>(*work);
}

bool push(Queue& queue, std::string request) { return queue.push_request(request); }

TEST(WorkQueue, gives_packets_and_requests_in_the_order_they_came) {
    Queue queue(4, 4);
    ASSERT_TRUE(push(queue, "a"));
    queue.push_packet(1);
    queue.push_packet(2);
    ASSERT_TRUE(push(queue, "b"));
    queue.push_packet(3);
    EXPECT_EQ(next(queue), "a");
    EXPECT_EQ(next(queue), "1");
    EXPECT_EQ(next(queue), "2");
    EXPECT_EQ(next(queue), "b");
    EXPECT_EQ(next(queue), "3");
}

TEST(WorkQueue, hands_back_the_oldest_packet_when_one_too_many_comes) {
    Queue queue(2, 4);
    EXPECT_FALSE(queue.push_packet(1));
    EXPECT_FALSE(queue.push_packet(2));
    EXPECT_EQ(queue.push_packet(3), 1);
    EXPECT_EQ(queue.push_packet(4), 2);
    EXPECT_EQ(next(queue), "3");
    EXPECT_EQ(next(queue), "4");
}

TEST(WorkQueue, drops_no_request_for_packets) {
    Queue queue(1, 1);
    ASSERT_TRUE(push(queue, "first"));
    for (int packet = 0; packet < 100; ++packet) queue.push_packet(packet);
    EXPECT_EQ(next(queue), "first");
    EXPECT_EQ(next(queue), "99");
}

TEST(WorkQueue, refuses_one_request_too_many_and_leaves_it_as_it_was) {
    Queue queue(1, 2);
    ASSERT_TRUE(push(queue, "a"));
    ASSERT_TRUE(push(queue, "b"));
    std::string third = "c";
    EXPECT_FALSE(queue.push_request(third));
    EXPECT_EQ(third, "c");
    EXPECT_EQ(next(queue), "a");
    EXPECT_TRUE(queue.push_request(third));
}

TEST(WorkQueue, tells_how_full_it_is_and_was) {
    Queue queue(3, 1);
    for (int packet = 0; packet < 5; ++packet) queue.push_packet(packet);
    next(queue);
    const auto figures = queue.figures();
    EXPECT_EQ(figures.packets, 2U);
    EXPECT_EQ(figures.packets_max, 3U);
    EXPECT_EQ(figures.capacity, 3U);
}

TEST(WorkQueue, returns_once_without_work_after_a_wake_and_then_the_work) {
    Queue queue(1, 1);
    queue.push_packet(1);
    queue.wake();
    EXPECT_EQ(next(queue), "nothing");
    EXPECT_EQ(next(queue), "1");
}

TEST(WorkQueue, gives_nothing_more_once_it_is_closed) {
    Queue queue(1, 1);
    queue.push_packet(1);
    queue.close();
    EXPECT_EQ(next(queue), "nothing");
    EXPECT_EQ(next(queue), "nothing");
    EXPECT_TRUE(queue.closed());
}

TEST(WorkQueue, hands_over_what_waited_when_it_was_closed_once) {
    Queue queue(4, 4);
    queue.push_packet(1);
    ASSERT_TRUE(push(queue, "a"));
    queue.push_packet(2);
    EXPECT_EQ(next(queue), "1");
    queue.close();
    EXPECT_THAT(queue.rest(), testing::ElementsAre(Queue::Work(2), Queue::Work("a")));
    EXPECT_TRUE(queue.rest().empty());
    EXPECT_EQ(queue.figures().packets, 0U);
}

TEST(WorkQueue, passes_everything_from_two_threads_to_a_third_in_each_threads_order) {
    constexpr int each = 20'000;
    Queue queue(each, each);
    std::thread packets([&] {
        for (int i = 0; i < each; ++i) queue.push_packet(i);
    });
    std::thread requests([&] {
        for (int i = 0; i < each; ++i) ASSERT_TRUE(push(queue, std::to_string(i)));
    });
    int next_packet = 0;
    int next_request = 0;
    while (next_packet < each || next_request < each) {
        const auto work = queue.pop();
        ASSERT_TRUE(work);
        if (const auto* packet = std::get_if<int>(&*work)) {
            ASSERT_EQ(*packet, next_packet++);
        } else {
            ASSERT_EQ(std::get<std::string>(*work), std::to_string(next_request++));
        }
    }
    packets.join();
    requests.join();
}

}  // namespace
}  // namespace pursuit::tracker
