// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/live_publisher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <future>
#include <memory>

#include "tests/unit/sensor/sent_packets.hpp"

namespace pursuit::sensor {
namespace {

using Hear = std::function<void(LiveSink&)>;

class ScriptedInput final : public LiveInput {
 public:
    explicit ScriptedInput(Hear hear) : hear_(std::move(hear)) {}
    void run(LiveSink& sink, const StopSignal& /*stop*/) override { hear_(sink); }

 private:
    Hear hear_;
};

/// With a queue of 100 events.
struct Live : SentToItsEnd<LivePublisher> {
    Live() { config.set_live_buffer_events(100); }
    void hear(Hear from) { run(std::make_unique<ScriptedInput>(std::move(from))); }
};

void push(LiveSink& sink, std::int64_t t_us, std::size_t count) {
    sink.push(events_from(t_us, count), {}, t_us + static_cast<std::int64_t>(count));
}

TEST(LivePublisher, tells_in_the_next_packet_and_counts_what_the_full_queue_pushed_out) {
    Live live;
    std::promise<void> sending;
    std::promise<void> heard;
    live.sent.takes = [&](const auto& packet) {
        if (packet.sequence_number() == 0) {
            sending.set_value();
            heard.get_future().wait();
        }
        return true;
    };
    live.hear([&](LiveSink& sink) {
        sink.begin({20, 10});
        push(sink, 0, 10);
        sending.get_future().wait();
        push(sink, 1'000, 60);
        push(sink, 2'000, 60);
        heard.set_value();
        sink.end("");
    });
    const auto& counts = live.publisher->counts();
    EXPECT_EQ(counts.events_in, 130U);
    EXPECT_EQ(counts.events_out, 70U);
    EXPECT_EQ(counts.events_overtaken, 60U);
    EXPECT_EQ(counts.events_in, counts.events_out + lost_events(counts));
    EXPECT_EQ(live.sent.events.front().dropped_events(), 0U);
    EXPECT_EQ(live.sent.events.back().dropped_events(), 60U);
}

TEST(LivePublisher, counts_a_packet_that_was_not_taken_and_tells_the_fault_of_the_stream) {
    Live live;
    live.sent.takes = [](const auto& packet) { return packet.sequence_number() != 0; };
    live.hear([](LiveSink& sink) {
        sink.begin({20, 10});
        push(sink, 0, 20);
        sink.end("the cable is out");
    });
    const auto& counts = live.publisher->counts();
    EXPECT_EQ(counts.events_in, 20U);
    EXPECT_EQ(counts.events_unsent, 10U);
    EXPECT_EQ(counts.events_in, counts.events_out + lost_events(counts));
    EXPECT_EQ(live.sent.events.back().dropped_events(), 10U);
    EXPECT_TRUE(live.sent.events.back().end_of_stream());
    ASSERT_EQ(live.sent.errors.size(), 2U);
    EXPECT_EQ(live.sent.errors.back(), "the cable is out");
}

}  // namespace
}  // namespace pursuit::sensor
