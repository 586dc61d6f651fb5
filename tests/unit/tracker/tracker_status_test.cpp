// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_status.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "tests/support/manual_clock.hpp"

namespace pursuit::tracker {
namespace {

v1::TrackerStatus status_of(const SessionFigures& figures, pursuit::test::ManualClock& clock) {
    return tracker_status({}, figures, {}, IntakeCounters{}, clock);
}

TEST(TrackerStatus, tells_how_far_behind_the_tracker_was_when_it_was_asked) {
    pursuit::test::ManualClock clock;
    SessionFigures figures;
    figures.last_t_us = 5;
    figures.last_host_time_ns = 1'000'000;
    figures.taken_host_time_ns = 3'500'000;
    EXPECT_EQ(status_of(figures, clock).lag_us(), 2'500);
    clock.advance(50'000'000);  // until it is told
    EXPECT_EQ(status_of(figures, clock).lag_us(), 2'500);
}

TEST(TrackerStatus, before_the_first_event_has_no_lag) {
    pursuit::test::ManualClock clock;
    SessionFigures figures;
    figures.taken_host_time_ns = 3'500'000;
    EXPECT_EQ(status_of(figures, clock).lag_us(), 0);
}

TEST(TrackerStatus, says_how_often_objects_were_lost_and_why_apart_from_what_was_dropped) {
    pursuit::test::ManualClock clock;
    SessionFigures figures;
    figures.tracker.lost_by[static_cast<std::size_t>(LossCause::gone)] = 3;
    const auto status = status_of(figures, clock);
    const auto named = std::find_if(status.dropped_by().begin(), status.dropped_by().end(),
                                    [](const auto& c) { return c.name() == "objects.lost.gone"; });
    ASSERT_NE(named, status.dropped_by().end());
    EXPECT_EQ(named->count(), 3U);
    EXPECT_EQ(status.events_dropped(), 0U);
    EXPECT_LE(status.dropped_by().size(), 32U);
}

// Every figure is another power of 2: a sum tells what is in it.
TEST(TrackerStatus, tells_each_cause_by_its_name_and_sums_up_those_of_events_alone) {
    pursuit::test::ManualClock clock;
    SessionFigures figures;
    figures.tracker.events_in = 1 << 0;
    figures.dropped_bad_geometry = 1 << 1;
    figures.tracker.dropped_outside_geometry = 1 << 2;
    figures.tracker.dropped_time_went_back = 1 << 3;
    figures.tracker.dropped_time_out_of_range = 1 << 4;
    figures.stream.old = 1 << 5;
    figures.stream.of_another_stream = 1 << 6;
    figures.stream.bad_geometry = 1 << 7;
    figures.late_refusals = 1 << 8;
    figures.write_failures = 1 << 9;
    IntakeCounters intake;
    intake.dropped_events = 1 << 10;
    intake.dropped_packets = 1 << 11;
    intake.of_another_sensor = 1 << 12;
    intake.refused_requests = 1 << 13;
    intake.left_events = 1 << 19;
    intake.left_packets = 1 << 20;
    intake.left_requests = 1 << 21;
    for (std::size_t i = 1; i < loss_causes; ++i) figures.tracker.lost_by[i] = 1U << (13 + i);
    const auto status = tracker_status({}, figures, {}, intake, clock);
    std::map<std::string, std::uint64_t> told;
    for (const auto& cause : status.dropped_by()) told[cause.name().to_string()] = cause.count();
    const std::map<std::string, std::uint64_t> expected{
        {"other_geometry", 1 << 1},
        {"outside_geometry", 1 << 2},
        {"time_went_back", 1 << 3},
        {"time_out_of_range", 1 << 4},
        {"packets.old", 1 << 5},
        {"packets.other_stream", 1 << 6},
        {"packets.other_geometry", 1 << 7},
        {"requests.refused_at_their_time", 1 << 8},
        {"writes.failed", 1 << 9},
        {"queue_full", 1 << 10},
        {"packets.queue_full", 1 << 11},
        {"packets.other_sensor", 1 << 12},
        {"requests.queue_full", 1 << 13},
        {"objects.lost.does_not_fit", 1 << 14},
        {"objects.lost.gone", 1 << 15},
        {"objects.lost.in_noise", 1 << 16},
        {"objects.lost.not_seen_again", 1 << 17},
        {"objects.lost.out_of_bounds", 1 << 18},
        {"left_at_stop", 1 << 19},
        {"packets.left_at_stop", 1 << 20},
        {"requests.left_at_stop", 1 << 21},
    };
    EXPECT_EQ(told, expected);
    EXPECT_EQ(status.dropped_by().size(), expected.size());
    EXPECT_EQ(status.events_dropped(), 1U << 1 | 1U << 2 | 1U << 3 | 1U << 4 | 1U << 10 | 1U << 19);
    // What never came to the tracker came in all the same.
    EXPECT_EQ(status.events_in(), 1U << 0 | 1U << 1 | 1U << 10 | 1U << 19);
}

TEST(TrackerStatus, tells_every_other_figure_as_it_is) {
    pursuit::test::ManualClock clock;
    SessionFigures figures;
    figures.stream_id = 1;
    figures.last_t_us = 2;
    figures.tracker.events_used = 3;
    figures.stream.packets = 4;
    figures.stream.gaps = 5;
    figures.stream.packets_missed = 6;
    figures.requests = 20;
    figures.requests_refused = 30;
    figures.poses_out = 7;
    figures.tracker.poses_thinned = 8;
    figures.objects = 9;
    figures.objects_tracking = 10;
    figures.objects_lost = 11;
    figures.busy_fraction = 0.5;
    figures.latency.p99_us(12);
    IntakeCounters intake;
    intake.refused_requests = 400;
    const auto status = tracker_status({"left", 13}, figures, {14, 15, 16}, intake, clock);
    EXPECT_EQ(status.instance().to_string(), "left");
    EXPECT_EQ(status.sensor_id(), 13U);
    EXPECT_EQ(status.stream_id(), 1U);
    EXPECT_EQ(status.last_t_us(), 2);
    EXPECT_EQ(status.events_used(), 3U);
    EXPECT_EQ(status.packets_in(), 4U);
    EXPECT_EQ(status.gaps(), 5U);
    EXPECT_EQ(status.packets_missed(), 6U);
    EXPECT_EQ(status.requests(), 420U);
    EXPECT_EQ(status.requests_refused(), 430U);
    EXPECT_EQ(status.poses_out(), 7U);
    EXPECT_EQ(status.poses_thinned(), 8U);
    EXPECT_EQ(status.objects(), 9U);
    EXPECT_EQ(status.objects_tracking(), 10U);
    EXPECT_EQ(status.objects_lost(), 11U);
    EXPECT_EQ(status.busy_fraction(), 0.5);
    EXPECT_EQ(status.latency().p99_us(), 12);
    EXPECT_EQ(status.queue_packets(), 14U);
    EXPECT_EQ(status.queue_packets_max(), 15U);
    EXPECT_EQ(status.queue_capacity(), 16U);
}

TEST(TrackerStatus, of_an_open_stream_without_packets_for_100_ms_is_a_fault) {
    SessionFigures figures;
    figures.stream_open = true;
    IntakeCounters intake;
    intake.last_packet_steady_ns = 1;
    EXPECT_FALSE(is_silent(figures, intake, 100'000'001));
    EXPECT_TRUE(is_silent(figures, intake, 100'000'002));
    figures.stream_open = false;
    EXPECT_FALSE(is_silent(figures, intake, 100'000'002));
}

TEST(TrackerStatus, counts_what_waited_still_at_the_end_as_dropped) {
    pursuit::test::ManualClock clock;
    SessionFigures figures;
    figures.tracker.events_in = 100;
    IntakeCounters intake;
    intake.left_packets = 2;
    intake.left_events = 30;
    intake.left_requests = 3;
    const auto status = tracker_status({}, figures, {}, intake, clock);
    EXPECT_EQ(status.events_in(), 130U);
    EXPECT_EQ(status.events_dropped(), 30U);
    EXPECT_EQ(status.requests(), 3U);
    EXPECT_EQ(status.requests_refused(), 3U);
}

TEST(TrackerStatus, is_a_fault_with_its_reason_while_the_store_is_not_written) {
    pursuit::test::ManualClock clock;
    SessionFigures figures;
    figures.stream_open = true;
    const auto status = status_of(figures, clock);
    EXPECT_EQ(state_of(status, figures, ""), v1::SERVICE_RUNNING);
    EXPECT_EQ(describe(status, figures, ""), "follows 0 objects in the events of sensor 1");
    EXPECT_EQ(state_of(status, figures, "disk full"), v1::SERVICE_FAULT);
    EXPECT_EQ(describe(status, figures, "disk full"),
              "follows 0 objects in the events of sensor 1; the store is not written: disk full");
}

TEST(TrackerStatus, says_how_many_calls_wait_for_their_time) {
    pursuit::test::ManualClock clock;
    SessionFigures figures;
    figures.calls_waiting = 2;
    EXPECT_EQ(describe(status_of(figures, clock), figures, ""),
              "waits for events of sensor 1, 0 objects registered; 2 calls wait for their time");
}

TEST(TrackerStatus, of_a_stream_that_has_ended_is_no_fault_while_the_tracker_is_behind) {
    SessionFigures figures;
    figures.stream_open = true;  // its end still waits
    TrackerQueue queue(4, 1);
    IntakeCounters intake;
    v1::EventPacket last;
    last.sensor_id(1);
    last.end_of_stream(true);
    take_in(last, 1, 1, queue, intake);
    EXPECT_FALSE(is_silent(figures, intake, 100'000'002));
    v1::EventPacket of_the_next_stream;
    of_the_next_stream.sensor_id(1);
    take_in(of_the_next_stream, 1, 2, queue, intake);
    EXPECT_TRUE(is_silent(figures, intake, 100'000'003));
}

}  // namespace
}  // namespace pursuit::tracker
