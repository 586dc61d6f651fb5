// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/stream_follower.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

PacketHeader packet(std::uint64_t stream_id, std::uint64_t sequence_number) {
    PacketHeader header;
    header.stream_id = stream_id;
    header.sequence_number = sequence_number;
    header.base_time_us = static_cast<std::int64_t>(sequence_number) * 1000;
    header.host_time_ns = 100 * second_ns + header.base_time_us * 1000;
    header.geometry = {304, 240};
    return header;
}

TEST(StreamFollower, begins_with_the_first_packet_and_continues_with_the_next) {
    StreamFollower follower;
    EXPECT_FALSE(follower.is_open());
    EXPECT_EQ(follower.take(packet(7, 5)), PacketFate::begins_stream);
    EXPECT_EQ(follower.take(packet(7, 6)), PacketFate::continues_stream);
    EXPECT_TRUE(follower.is_open());
    EXPECT_EQ(follower.stream_id(), 7U);
    EXPECT_EQ(follower.counters().packets, 2U);
    EXPECT_EQ(follower.counters().gaps, 0U);
}

TEST(StreamFollower, counts_a_gap_and_the_packets_in_it) {
    StreamFollower follower;
    follower.take(packet(7, 1));
    EXPECT_EQ(follower.take(packet(7, 5)), PacketFate::continues_stream);
    EXPECT_EQ(follower.counters().gaps, 1U);
    EXPECT_EQ(follower.counters().packets_missed, 3U);
}

TEST(StreamFollower, leaves_a_duplicate_and_an_older_packet_and_counts_them) {
    StreamFollower follower;
    follower.take(packet(7, 4));
    EXPECT_EQ(follower.take(packet(7, 4)), PacketFate::old);
    EXPECT_EQ(follower.take(packet(7, 3)), PacketFate::old);
    EXPECT_EQ(follower.take(packet(7, 5)), PacketFate::continues_stream);
    EXPECT_EQ(follower.counters().old, 2U);
    EXPECT_EQ(follower.counters().gaps, 0U);
}

TEST(StreamFollower, begins_a_new_stream_and_leaves_late_packets_of_the_one_before) {
    StreamFollower follower;
    follower.take(packet(7, 1));
    EXPECT_EQ(follower.take(packet(8, 1)), PacketFate::begins_stream);
    EXPECT_EQ(follower.take(packet(7, 2)), PacketFate::of_another_stream);
    EXPECT_EQ(follower.take(packet(8, 2)), PacketFate::continues_stream);
    EXPECT_EQ(follower.counters().of_another_stream, 1U);
}

TEST(StreamFollower, follows_the_newest_of_two_live_streams_all_the_time) {
    StreamFollower follower;
    follower.take(packet(7, 1));
    follower.take(packet(8, 1));
    for (std::uint64_t i = 2; i < 2000; ++i) {
        ASSERT_EQ(follower.take(packet(7, i)), PacketFate::of_another_stream);
        ASSERT_EQ(follower.take(packet(8, i)), PacketFate::continues_stream);
    }
    EXPECT_EQ(follower.counters().streams, 2U);
}

TEST(StreamFollower, goes_back_to_a_left_stream_when_the_followed_one_has_ended) {
    StreamFollower follower;
    follower.take(packet(7, 1));
    follower.take(packet(8, 1));
    auto last = packet(8, 2);
    last.end_of_stream = true;
    EXPECT_EQ(follower.take(last), PacketFate::continues_stream);
    EXPECT_FALSE(follower.is_open());
    EXPECT_EQ(follower.take(packet(7, 3)), PacketFate::begins_stream);
}

TEST(StreamFollower, goes_back_to_a_left_stream_when_the_followed_one_is_silent_for_a_second) {
    StreamFollower follower;
    follower.take(packet(7, 1));
    follower.take(packet(8, 1));
    auto later = packet(7, 2);
    later.host_time_ns = packet(8, 1).host_time_ns + second_ns;
    EXPECT_EQ(follower.take(later), PacketFate::of_another_stream);
    later.host_time_ns += 1;
    EXPECT_EQ(follower.take(later), PacketFate::begins_stream);
}

TEST(StreamFollower, begins_anew_when_a_recording_is_played_again_before_or_after_its_end) {
    StreamFollower follower;
    for (std::uint64_t i = 1; i < 10; ++i) follower.take(packet(7, i));
    auto again = packet(7, 1);
    again.host_time_ns += second_ns;
    EXPECT_EQ(follower.take(again), PacketFate::begins_stream);
    EXPECT_EQ(follower.counters().old, 0U);
    auto end = packet(7, 2);
    end.host_time_ns += second_ns;
    end.end_of_stream = true;
    follower.take(end);
    again.host_time_ns += second_ns;
    EXPECT_EQ(follower.take(again), PacketFate::begins_stream);
}

TEST(StreamFollower, refuses_a_packet_without_pixels_or_with_too_many_and_one_of_another_geometry) {
    StreamFollower follower;
    for (const Geometry unusable_one : {Geometry{0, 240}, Geometry{65'535, 65'535}}) {
        auto unusable = packet(7, 1);
        unusable.geometry = unusable_one;
        EXPECT_EQ(follower.take(unusable), PacketFate::bad_geometry);
    }
    follower.take(packet(7, 2));
    auto other = packet(7, 3);
    other.geometry = {640, 480};
    EXPECT_EQ(follower.take(other), PacketFate::bad_geometry);
    EXPECT_EQ(follower.take(packet(7, 4)), PacketFate::continues_stream);
    EXPECT_EQ(follower.counters().gaps, 0U);
    EXPECT_EQ(follower.counters().bad_geometry, 3U);
}

}  // namespace
}  // namespace pursuit::tracker
