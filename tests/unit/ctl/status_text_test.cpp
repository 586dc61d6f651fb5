// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/status_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pursuit::ctl {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

v1::NamedCount cause(const char* name, std::uint64_t count) {
    v1::NamedCount named;
    named.name(name);
    named.count(count);
    return named;
}

v1::TrackerStatus tracker() {
    v1::TrackerStatus status;
    status.instance("left");
    status.health().state(v1::SERVICE_RUNNING);
    status.health().detail("follows 3 objects");
    status.last_t_us(2'500'000);
    status.events_in(100);
    status.events_used(60);
    status.events_dropped(7);
    status.dropped_by({cause("queue_full", 4), cause("other_geometry", 0),
                       cause("time_went_back", 3), cause("objects.lost.gone", 2),
                       cause("objects.lost.in_noise", 1)});
    status.packets_in(11);
    status.gaps(12);
    status.packets_missed(13);
    status.queue_packets(14);
    status.queue_packets_max(15);
    status.queue_capacity(16);
    status.objects(3);
    status.objects_tracking(2);
    status.objects_lost(1);
    status.poses_out(17);
    status.poses_thinned(18);
    status.busy_fraction(0.25);
    status.latency().p50_us(19);
    status.latency().p99_us(20);
    status.latency().max_us(21);
    return status;
}

TEST(StatusLines, of_a_tracker_tell_every_figure_and_the_causes_that_counted) {
    EXPECT_EQ(status_lines(tracker()),
              "tracker   left         RUNNING   follows 3 objects\n"
              "          events in 100, used 60, dropped 7 (queue_full 4, time_went_back 3)\n"
              "          packets 11, gaps 12, missed 13; queue 14, at most 15 of 16\n"
              "          objects 3, tracking 2, lost 1 (gone 2, in_noise 1); poses 17, thinned 18\n"
              "          at 2.500 s; busy 25.0 %; latency p50 19, p99 20, max 21 us\n");
}

TEST(StatusLines, of_a_tracker_without_an_event_or_a_loss_say_so_and_name_no_cause) {
    auto status = tracker();
    status.last_t_us(-1);
    status.dropped_by({cause("queue_full", 0), cause("objects.lost.gone", 0)});
    const auto text = status_lines(status);
    EXPECT_THAT(text, HasSubstr("before the first event; busy"));
    EXPECT_THAT(text, HasSubstr("dropped 7\n"));
    EXPECT_THAT(text, HasSubstr("lost 1; poses"));
}

TEST(StatusLines, tell_of_errors_and_of_samples_lost_where_there_were_any) {
    auto status = tracker();
    EXPECT_THAT(status_lines(status), Not(HasSubstr("errors")));
    EXPECT_THAT(status_lines(status), Not(HasSubstr("malformed")));
    status.health().errors(2);
    status.health().last_error("the disk is full");
    status.health().lost_samples(5);
    EXPECT_THAT(status_lines(status), HasSubstr("\n          2 errors, the last: the disk is full\n"
                                                "          samples malformed 0, lost 5\n"));
}

TEST(StatusLines, of_a_sensor_tell_its_source_rate_and_balance) {
    v1::SensorStatus status;
    status.instance("default");
    status.health().state(v1::SERVICE_PAUSED);
    status.source("car.raw");
    status.width(304);
    status.height(240);
    status.rate(0.5);
    status.last_t_us(1'000);
    status.events_in(10);
    status.events_out(7);
    status.event_rate_hz(12.4);
    status.packets_out(2);
    status.events_dropped(3);
    status.dropped_by({cause("filter.polarity", 3)});
    EXPECT_EQ(status_lines(status),
              "sensor    default      PAUSED    \n"
              "          car.raw, 304 x 240 px, rate 0.5, at 0.001 s\n"
              "          events in 10, out 7 (12/s), packets 2, dropped 3 (filter.polarity 3)\n");
}

TEST(StatusLines, of_a_recorder_tell_whether_it_records_or_replays) {
    v1::RecorderStatus status;
    status.file("run.mcap");
    status.messages(4);
    status.messages_dropped(1);
    status.dropped_by({cause("paused", 1)});
    status.bytes_written(5);
    status.chunks_written(6);
    status.gaps(7);
    EXPECT_THAT(
        status_lines(status),
        EndsWith("\n          records to run.mcap\n"
                 "          messages 4, dropped 1 (paused 1); bytes 5, chunks 6; gaps 7\n"));
    status.replaying(true);
    EXPECT_THAT(status_lines(status), HasSubstr("          replays run.mcap\n"));
}

TEST(StatusJson, has_the_causes_as_an_object_with_those_that_are_0) {
    const auto json = status_json(tracker());
    EXPECT_THAT(json, HasSubstr(R"("events_dropped": 7, "dropped_by": {"queue_full": 4, )"
                                R"("other_geometry": 0, "time_went_back": 3, )"
                                R"("objects.lost.gone": 2, "objects.lost.in_noise": 1})"));
    EXPECT_THAT(json, HasSubstr(R"("state": "RUNNING")"));
}

TEST(StateName, of_a_state_that_is_none_is_a_question_mark) {
    EXPECT_EQ(state_name(v1::SERVICE_STARTING), "STARTING");
    EXPECT_EQ(state_name(v1::SERVICE_FAULT), "FAULT");
    EXPECT_EQ(state_name(static_cast<v1::ServiceState>(99)), "?");
}

}  // namespace
}  // namespace pursuit::ctl
