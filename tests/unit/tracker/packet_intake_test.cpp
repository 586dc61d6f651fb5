// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/packet_intake.hpp"

#include <gtest/gtest.h>

namespace pursuit::tracker {
namespace {

v1::EventPacket packet_of(std::uint32_t sensor_id, std::uint64_t sequence_number) {
    v1::EventPacket packet;
    packet.sensor_id(sensor_id);
    packet.sequence_number(sequence_number);
    packet.words().resize(4);
    return packet;
}

struct Intake {
    void take(v1::EventPacket packet, std::int64_t steady_ns) {
        take_in(packet, 1, steady_ns, queue, counters);
    }

    TrackerQueue queue{2, 1};
    IntakeCounters counters;
};

TEST(PacketIntake, gives_no_room_to_packets_of_another_sensor_and_counts_them_apart) {
    Intake intake;
    intake.take(packet_of(1, 1), 10);
    intake.take(packet_of(1, 2), 20);
    for (std::uint64_t i = 0; i < 12; ++i) intake.take(packet_of(2, i), 30);
    EXPECT_EQ(intake.counters.of_another_sensor, 12U);
    EXPECT_EQ(intake.counters.dropped_packets, 0U);
    EXPECT_EQ(intake.counters.dropped_events, 0U);
    EXPECT_EQ(intake.counters.last_packet_steady_ns, 20);
    EXPECT_EQ(intake.queue.figures().packets, 2U);
    EXPECT_EQ(std::get<v1::EventPacket>(*intake.queue.pop()).sequence_number(), 1U);
}

TEST(PacketIntake, counts_the_oldest_packet_that_makes_room_and_its_events) {
    Intake intake;
    for (std::uint64_t i = 1; i <= 3; ++i) intake.take(packet_of(1, i), 10);
    EXPECT_EQ(intake.counters.dropped_packets, 1U);
    EXPECT_EQ(intake.counters.dropped_events, 4U);
    EXPECT_EQ(std::get<v1::EventPacket>(*intake.queue.pop()).sequence_number(), 2U);
}

}  // namespace
}  // namespace pursuit::tracker
