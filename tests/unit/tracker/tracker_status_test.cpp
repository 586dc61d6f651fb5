// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_status.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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
