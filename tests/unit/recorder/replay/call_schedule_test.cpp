// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/call_schedule.hpp"

#include <gtest/gtest.h>

#include "tests/unit/recorder/packet_payload.hpp"

namespace pursuit::recorder {
namespace {

PlannedCall planned_call(std::string name, std::size_t stream, std::int64_t apply_at_us) {
    PlannedCall call;
    call.name = std::move(name);
    call.stream = stream;
    call.request.apply_at_us(apply_at_us);
    return call;
}

/// The names of calls; one that begins a stream with a "*".
std::vector<std::string> names_of(const std::vector<CallSchedule::DueCall>& calls) {
    std::vector<std::string> names;
    for (const auto& each : calls)
        names.push_back(each.call.name + (each.begins_stream ? "*" : ""));
    return names;
}

/// What is due at a packet with events from 100 to 200 µs after that base.
std::vector<std::string> due_at(CallSchedule& schedule, std::uint32_t sensor_id,
                                std::uint64_t stream_id, std::int64_t base_us) {
    v1::EventPacket packet;
    packet.sensor_id(sensor_id);
    packet.stream_id(stream_id);
    packet.base_time_us(base_us);
    packet.words().push_back(std::uint64_t{100} << 32);
    packet.words().push_back(std::uint64_t{200} << 32);
    const auto payload = packet_payload(packet);
    return names_of(schedule.take(*PacketFields::of(payload)));
}

using Names = std::vector<std::string>;

TEST(CallSchedule, without_calls_has_none_due) {
    CallSchedule schedule;
    EXPECT_EQ(due_at(schedule, 1, 7, 0), Names{});
    EXPECT_EQ(names_of(schedule.take_rest()), Names{});
}

TEST(CallSchedule, gives_each_call_once_before_the_packet_that_reaches_its_time) {
    CallSchedule schedule({{1,
                            {planned_call("at 200", 0, 200), planned_call("at 201", 0, 201),
                             planned_call("at 1200", 0, 1200), planned_call("later", 0, 9000)}}});
    EXPECT_EQ(due_at(schedule, 1, 7, 0), Names{"at 200"});
    EXPECT_EQ(due_at(schedule, 1, 7, 0), Names{});
    EXPECT_EQ(due_at(schedule, 1, 7, 1000), (Names{"at 201", "at 1200"}));
    EXPECT_EQ(names_of(schedule.take_rest()), Names{"later"});
    EXPECT_EQ(names_of(schedule.take_rest()), Names{});
}

TEST(CallSchedule, tells_a_call_that_precedes_all_of_a_stream_from_one_within_its_first_packet) {
    CallSchedule schedule(
        {{1, {planned_call("at first event", 0, 100), planned_call("within", 0, 101)}}});
    EXPECT_EQ(due_at(schedule, 1, 7, 0), (Names{"at first event*", "within"}));
}

TEST(CallSchedule, makes_what_is_left_of_a_stream_when_the_next_begins) {
    CallSchedule schedule({{1,
                            {planned_call("of the first", 0, 9000), planned_call("early", 1, 50),
                             planned_call("late", 1, 5000)}}});
    EXPECT_EQ(due_at(schedule, 1, 7, 0), Names{});
    EXPECT_EQ(due_at(schedule, 1, 8, 0), (Names{"of the first*", "early*"}));
    EXPECT_EQ(due_at(schedule, 1, 8, 5000), Names{"late"});
}

TEST(CallSchedule, keeps_the_calls_of_several_sensors_apart) {
    CallSchedule schedule({{1, {planned_call("one", 0, 0)}}, {2, {planned_call("two", 0, 0)}}});
    EXPECT_EQ(due_at(schedule, 3, 7, 0), Names{});
    EXPECT_EQ(due_at(schedule, 2, 7, 0), Names{"two*"});
    EXPECT_EQ(names_of(schedule.take_rest()), Names{"one"});
}

}  // namespace
}  // namespace pursuit::recorder
