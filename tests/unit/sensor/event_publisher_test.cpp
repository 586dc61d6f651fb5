// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/event_publisher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "tests/unit/sensor/sent_packets.hpp"

namespace pursuit::sensor {
namespace {

using ::testing::ElementsAre;

/// So many events 1 us apart, then its end or an error.
class ShortSource final : public EventReader {
 public:
    ShortSource(std::size_t events, bool fails) : events_(events_from(0, events)), fails_(fails) {}
    Geometry geometry() const override { return {20, 10}; }

 private:
    Decoded decode(std::span<Event> events, std::span<Event> /*exposures*/) override {
        Decoded done;
        done.count = events_.size();
        std::copy(events_.begin(), events_.end(), events.begin());
        if (events_.empty() && fails_) done.error = Error{"the source broke off"};
        events_.clear();
        return done;
    }
    std::vector<Event> events_;
    bool fails_;
};

struct Published : SentToItsEnd<EventPublisher> {
    Published(std::size_t events, bool fails, std::function<bool(const v1::EventPacket&)> takes) {
        sent.takes = std::move(takes);
        run(std::make_unique<ShortSource>(events, fails));
    }
};

TEST(EventPublisher, sends_all_of_a_source_and_its_end) {
    const Published published(25, false, [](const auto&) { return true; });
    EXPECT_EQ(published.publisher->state(), Publisher::State::finished);
    const auto& counts = published.publisher->counts();
    EXPECT_EQ(counts.events_in, 25U);
    EXPECT_EQ(counts.events_out, 25U);
    EXPECT_EQ(counts.packets_out, 4U);
    EXPECT_EQ(lost_events(counts), 0U);
    ASSERT_EQ(published.sent.events.size(), 4U);
    EXPECT_TRUE(published.sent.events.back().end_of_stream());
    EXPECT_TRUE(published.sent.errors.empty());
}

TEST(EventPublisher, sends_what_there_is_of_a_source_that_fails_and_its_end) {
    const Published published(25, true, [](const auto&) { return true; });
    EXPECT_EQ(published.publisher->state(), Publisher::State::failed);
    EXPECT_EQ(published.publisher->counts().events_out, 25U);
    EXPECT_TRUE(published.sent.events.back().end_of_stream());
    EXPECT_THAT(published.sent.errors, ElementsAre("the source broke off"));
}

TEST(EventPublisher, goes_on_behind_a_packet_that_was_not_taken_and_tells_of_it) {
    const Published published(
        25, false, [](const v1::EventPacket& packet) { return packet.sequence_number() != 0; });
    EXPECT_EQ(published.publisher->state(), Publisher::State::finished);
    const auto& counts = published.publisher->counts();
    EXPECT_EQ(counts.events_in, counts.events_out + lost_events(counts));
    EXPECT_THAT(dropped_events(published.sent.events), ElementsAre(0, 10, 10, 10));
    EXPECT_EQ(published.sent.errors.size(), 1U);
}

}  // namespace
}  // namespace pursuit::sensor
