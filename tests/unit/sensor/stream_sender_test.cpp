// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/stream_sender.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "tests/support/manual_clock.hpp"
#include "tests/unit/sensor/sent_packets.hpp"

namespace pursuit::sensor {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A sender of packets of 10 events, as fast as possible unless said otherwise.
struct Sending {
    explicit Sending(const std::string& filter = "", double rate = 0) : pacer(clock, rate) {
        config.set_packet_events(10);
        std::vector<FilterSetting> settings;
        if (!filter.empty()) settings.push_back(*parse_filter(filter));
        filters = std::move(*FilterSwitch::make(std::move(settings)));
        sender.emplace(config, outputs, pacer, clock, *filters, counts,
                       [](std::int64_t t_us) { return t_us * 1000; });
        EXPECT_TRUE(sender->begin({20, 10}));
    }
    bool send(std::vector<Event> events, std::vector<Event> exposures = {}) {
        const auto reached_us = events.empty() ? exposures.back().t_us : events.back().t_us;
        return sender->send(events, exposures, reached_us);
    }

    disk::SensorConfig config;
    pursuit::test::ManualClock clock{0, 1'000};
    Pacer pacer;
    std::unique_ptr<FilterSwitch> filters;
    PublisherCounts counts;
    SentPackets sent;
    StreamOutputs outputs = sent.outputs();
    std::optional<StreamSender> sender;
};

TEST(StreamSender, tells_in_each_packet_how_many_events_of_its_stream_were_not_taken_before_it) {
    Sending sending;
    sending.sent.takes = [](const auto& packet) { return packet.sequence_number() != 1; };
    sending.send(events_from(0, 30));
    sending.sender->end();
    EXPECT_THAT(dropped_events(sending.sent.events), ElementsAre(0, 0, 10, 10));
    EXPECT_EQ(sending.counts.events_in, 30U);
    EXPECT_EQ(sending.counts.events_out, 20U);
    EXPECT_EQ(sending.counts.events_unsent, 10U);
    ASSERT_EQ(sending.sent.errors.size(), 1U);
    EXPECT_THAT(sending.sent.errors[0], HasSubstr("10 events could not be published"));

    sending.clock.advance(1);
    ASSERT_TRUE(sending.sender->begin({20, 10}));
    sending.send(events_from(0, 10));
    EXPECT_EQ(sending.sent.events.back().dropped_events(), 0U);
    EXPECT_EQ(sending.sent.events.back().sequence_number(), 0U);
}

TEST(StreamSender, accounts_for_every_event_of_a_stream_that_is_filtered_refused_and_stopped) {
    Sending sending("polarity keep=1");
    sending.sent.takes = [&](const auto& packet) {
        if (packet.sequence_number() == 2) sending.pacer.stop();
        return packet.sequence_number() != 1;
    };
    EXPECT_FALSE(sending.send(events_from(0, 100)));
    EXPECT_FALSE(sending.send(events_from(100, 5)));
    sending.sender->end();
    EXPECT_EQ(sending.counts.events_in, 105U);
    EXPECT_EQ(sending.counts.events_out, 30U);  // the stop finds one more packet made
    EXPECT_EQ(sending.counts.events_unsent, 10U);
    EXPECT_EQ(sending.counts.events_left, 15U);
    EXPECT_EQ(sending.counts.filtered[*find_filter_kind("polarity")], 50U);
    EXPECT_EQ(sending.counts.events_in, sending.counts.events_out + lost_events(sending.counts));
    EXPECT_TRUE(sending.sent.events.back().end_of_stream());
}

TEST(StreamSender, tells_in_packets_what_the_rate_control_thinned_and_not_what_others_left_out) {
    Sending polarity("polarity keep=1");
    polarity.send(events_from(0, 100));
    polarity.sender->end();
    EXPECT_EQ(polarity.sent.events.back().dropped_events(), 0U);

    Sending rate("rate_control max_rate_hz=10000 window_us=1000");
    rate.send(events_from(0, 100));
    rate.sender->end();
    const auto thinned = rate.counts.filtered[*find_filter_kind("rate_control")].load();
    EXPECT_GT(thinned, 0U);
    EXPECT_EQ(rate.sent.events.back().dropped_events(), thinned);
    EXPECT_EQ(rate.counts.events_out, 100 - thinned);
}

TEST(StreamSender, counts_measurements_that_were_not_taken_apart_from_events) {
    Sending sending;
    sending.sent.takes = [&](const auto&) { return sending.sent.exposures.size() != 1; };
    sending.send(events_from(0, 10), events_from(0, 30));
    sending.sender->end();
    EXPECT_THAT(dropped_events(sending.sent.exposures), ElementsAre(0, 10, 10, 10));
    EXPECT_EQ(sending.counts.exposures_out, 20U);
    EXPECT_EQ(sending.counts.exposures_unsent, 10U);
    EXPECT_EQ(sending.counts.events_unsent, 0U);
    EXPECT_EQ(sending.sent.events.back().dropped_events(), 0U);
    ASSERT_EQ(sending.sent.errors.size(), 1U);
    EXPECT_THAT(sending.sent.errors[0], HasSubstr("10 exposures could not be published"));
}

TEST(StreamSender, as_fast_as_possible_waits_for_readers_every_16_packets_and_counts_in_vain) {
    Sending sending;
    sending.send(events_from(0, 150));
    EXPECT_EQ(sending.sent.waits, 0);
    sending.send(events_from(150, 10));
    EXPECT_EQ(sending.sent.waits, 1);
    EXPECT_EQ(sending.counts.packets_unacknowledged, 0U);
    sending.sent.acknowledges = [] { return false; };
    sending.send(events_from(160, 320));
    EXPECT_EQ(sending.sent.waits, 3);
    EXPECT_EQ(sending.counts.packets_unacknowledged, 32U);
    // What a reader misses it sees by the packets' numbers: nothing was dropped here.
    EXPECT_EQ(sending.sent.events.back().dropped_events(), 0U);
}

TEST(StreamSender, waits_for_no_reader_at_a_rate_or_where_its_source_cannot_wait) {
    Sending at_a_rate("", 1);
    at_a_rate.send(events_from(0, 200));
    EXPECT_EQ(at_a_rate.sent.waits, 0);

    Sending live;
    live.sender->await_readers(false);
    live.send(events_from(0, 200));
    EXPECT_EQ(live.sent.waits, 0);
    live.sender->farewell();
    EXPECT_EQ(live.sent.waits, 1);
}

}  // namespace
}  // namespace pursuit::sensor
