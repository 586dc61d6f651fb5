// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/scheduled_tracker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "services/tracker/tracker_wire.hpp"

namespace pursuit::tracker {
namespace {

using ::testing::HasSubstr;

constexpr Geometry geometry{304, 240};

struct Poses : PoseSink {
    struct Seen {
        std::int64_t t_us;
        std::uint32_t object_id;
        Pose pose;
        bool operator==(const Seen&) const = default;
    };
    std::vector<Seen> seen;
    void pose(const PoseRecord& record) override {
        seen.push_back({record.t_us, record.object_id, record.pose});
    }
};

v1::TrackerCall registration(const std::string& name, double x_px, std::size_t points = 40) {
    Registration square;
    square.shape.name = name;
    for (std::size_t i = 0; i < points; ++i) {
        const auto along = static_cast<float>(i % 10) * 2 - 9;
        const float side = i / 10 % 2 == 0 ? -9.0F : 9.0F;
        if (i / 20 % 2 == 0) {
            square.shape.points_px.emplace_back(along, side);
        } else {
            square.shape.points_px.emplace_back(side, along);
        }
    }
    square.estimator = EstimatorKind::gradient;
    square.start.pose.t_px = {x_px, 120};
    v1::TrackerCall call;
    call.register_model(register_model(square));
    return call;
}

v1::TrackerCall pose_call(const std::string& name, double x_px) {
    Start start;
    start.pose.t_px = {x_px, 120};
    v1::SetPose set;
    set.name(name);
    set.pose(start_pose(start));
    v1::TrackerCall call;
    call.set_pose(set);
    return call;
}

v1::TrackerCall removal(const std::string& name) {
    v1::ModelName model;
    model.name(name);
    v1::TrackerCall call;
    call.remove_model(model);
    return call;
}

ScheduledTracker fresh(std::vector<std::string>* late = nullptr) {
    ScheduledTracker tracker(*Tracker::create({}), {"test", 1},
                             [late](const v1::TrackerCall&, const CallAnswer& answer) {
                                 if (late != nullptr && !answer.ok()) {
                                     late->push_back(answer.outcome.message().to_string());
                                 }
                             });
    tracker.begin_stream(geometry, 1);
    return tracker;
}

/// Events around an outline that drifts, with several at one time and quiet stretches.
std::vector<Event> events() {
    std::mt19937 random(3);
    std::vector<Event> made;
    std::int64_t t_us = 10;
    for (int i = 0; i < 20'000; ++i) {
        t_us += random() % 4 == 0 ? static_cast<std::int64_t>(random() % 60) : 0;
        const double drift_px = static_cast<double>(t_us) * 4e-5;
        const int along = static_cast<int>(random() % 19) - 9;
        const int side = random() % 2 == 0 ? -9 : 9;
        const bool across = random() % 2 == 0;
        made.push_back({t_us, static_cast<std::uint16_t>(100 + drift_px + (across ? along : side)),
                        static_cast<std::uint16_t>(120 + (across ? side : along)),
                        static_cast<std::uint8_t>(random() % 2)});
    }
    return made;
}

TEST(ScheduledTracker, gives_a_call_the_time_behind_the_last_event) {
    auto tracker = fresh();
    Poses poses;
    auto first = registration("a", 100);
    EXPECT_EQ(tracker.call(first, 0).effective_time_us, 0);
    const Event event{500, 1, 1, 1};
    tracker.process(std::span(&event, 1), poses);
    auto second = registration("b", 200);
    EXPECT_EQ(tracker.call(second, 0).effective_time_us, 501);
    tracker.advance(700, poses);
    auto third = removal("b");
    EXPECT_EQ(tracker.call(third, 0).effective_time_us, 701);
}

TEST(ScheduledTracker, refuses_a_time_that_is_processed_and_changes_nothing) {
    auto tracker = fresh();
    Poses poses;
    tracker.advance(700, poses);
    auto call = registration("a", 100);
    const auto late = tracker.call(call, 700);
    EXPECT_EQ(late.answer.outcome.code(), v1::STATUS_TOO_LATE);
    EXPECT_THAT(late.answer.outcome.message().to_string(), HasSubstr("at least 701"));
    EXPECT_TRUE(tracker.tracker().object_names().empty());
    const auto now = tracker.call(call, 701);
    EXPECT_TRUE(now.answer.ok() && now.answer.changed);
    EXPECT_EQ(now.effective_time_us, 701);
    EXPECT_EQ(tracker.waiting(), 0U);
}

TEST(ScheduledTracker, refuses_a_negative_time) {
    auto tracker = fresh();
    auto call = registration("a", 100);
    EXPECT_EQ(tracker.call(call, -1).answer.outcome.code(), v1::STATUS_INVALID_ARGUMENT);
}

// The same calls, once made by hand between two events, once sent ahead with their time.
TEST(ScheduledTracker, gives_the_same_poses_for_calls_ahead_as_for_calls_in_time_however_cut) {
    const auto all = events();
    const std::int64_t set_us = all[9'000].t_us;
    const std::int64_t second_us = all[5'001].t_us + 1;
    const auto by_hand = [&] {
        auto tracker = fresh();
        Poses poses;
        auto first = registration("a", 100);
        tracker.call(first, 0);
        std::vector<std::pair<std::int64_t, v1::TrackerCall>> calls{
            {second_us, registration("b", 101)},
            {set_us, pose_call("a", 102)},
            {set_us, removal("b")}};
        std::size_t next = 0;
        for (const auto& event : all) {
            for (; next < calls.size() && event.t_us >= calls[next].first; ++next) {
                tracker.advance(calls[next].first - 1, poses);
                EXPECT_TRUE(tracker.call(calls[next].second, 0).answer.ok());
            }
            tracker.process(std::span(&event, 1), poses);
        }
        return poses.seen;
    }();
    ASSERT_GT(by_hand.size(), 50U);
    for (const std::size_t batch : {1UL, 7UL, 512UL, all.size()}) {
        auto tracker = fresh();
        Poses poses;
        auto first = registration("a", 100);
        auto second = registration("b", 101);
        auto set = pose_call("a", 102);
        auto remove = removal("b");
        EXPECT_TRUE(tracker.call(first, 0).answer.ok());
        EXPECT_EQ(tracker.call(second, second_us).effective_time_us, second_us);
        EXPECT_TRUE(tracker.call(set, set_us).answer.ok());
        EXPECT_TRUE(tracker.call(remove, set_us).answer.ok());
        EXPECT_EQ(tracker.waiting(), 3U);
        for (std::size_t begin = 0; begin < all.size(); begin += batch) {
            const auto count = std::min(batch, all.size() - begin);
            tracker.process(std::span(all).subspan(begin, count), poses);
        }
        EXPECT_EQ(tracker.waiting(), 0U);
        EXPECT_TRUE(poses.seen == by_hand) << "cut every " << batch << " events";
    }
}

TEST(ScheduledTracker, makes_calls_of_one_time_in_the_order_they_came) {
    auto tracker = fresh();
    Poses poses;
    auto add = registration("a", 100);
    auto remove = removal("a");
    auto again = registration("a", 50);
    EXPECT_TRUE(tracker.call(add, 1000).answer.ok());
    EXPECT_TRUE(tracker.call(remove, 1000).answer.ok());
    EXPECT_TRUE(tracker.call(again, 1000).answer.ok());
    tracker.advance(2000, poses);
    EXPECT_EQ(tracker.tracker().object("a")->start.pose.t_px.x(), 50);
    EXPECT_EQ(tracker.tracker().object("a")->effective_time_us, 1000);
}

TEST(ScheduledTracker, tries_a_call_behind_those_that_wait_before_it) {
    auto tracker = fresh();
    auto add = registration("a", 100);
    auto early = removal("a");
    auto in_time = removal("a");
    EXPECT_TRUE(tracker.call(add, 1000).answer.ok());
    EXPECT_EQ(tracker.call(early, 999).answer.outcome.code(), v1::STATUS_NOT_FOUND);
    EXPECT_TRUE(tracker.call(in_time, 1001).answer.ok());
}

TEST(ScheduledTracker, tells_of_a_call_that_is_refused_at_its_time_and_changes_nothing) {
    std::vector<std::string> late;
    auto tracker = fresh(&late);
    Poses poses;
    auto add = registration("a", 100);
    auto set = pose_call("a", 50);
    auto remove = removal("a");
    tracker.call(add, 0);
    EXPECT_TRUE(tracker.call(set, 1000).answer.ok());
    EXPECT_TRUE(tracker.call(remove, 0).answer.ok());
    tracker.advance(1000, poses);
    ASSERT_EQ(late.size(), 1U);
    EXPECT_THAT(late[0], HasSubstr("'a'"));
}

std::uint32_t id_of(const ScheduledTracker::Accepted& accepted) {
    EXPECT_TRUE(accepted.answer.ok()) << accepted.answer.outcome.message();
    return accepted.answer.ok() ? accepted.answer.result.register_model().object_id() : 0;
}

TEST(ScheduledTracker, gives_the_id_that_it_has_told_to_no_other_object) {
    auto tracker = fresh();
    Poses poses;
    auto later = registration("later", 100);
    EXPECT_EQ(id_of(tracker.call(later, 400)), 1U);
    auto latest = registration("latest", 100);
    EXPECT_EQ(id_of(tracker.call(latest, 500)), 2U);
    auto before = registration("before", 100);
    EXPECT_EQ(id_of(tracker.call(before, 300)), 3U);
    auto now = registration("now", 200);
    EXPECT_EQ(id_of(tracker.call(now, 0)), 4U);
    auto thief = registration("thief", 200);
    thief.register_model().object_id(1);
    EXPECT_EQ(tracker.call(thief, 0).answer.outcome.code(), v1::STATUS_ALREADY_EXISTS);
    tracker.advance(600, poses);
    EXPECT_EQ(tracker.tracker().object("later")->object_id, 1U);
    EXPECT_EQ(tracker.tracker().object("latest")->object_id, 2U);
    EXPECT_EQ(tracker.tracker().object("before")->object_id, 3U);
    EXPECT_EQ(tracker.tracker().object("now")->object_id, 4U);
}

TEST(ScheduledTracker, gives_the_same_ids_to_the_same_calls_by_number_in_order_of_time) {
    auto tracker = fresh();
    for (const auto& [name, id] : {std::pair{"now", 4U}, {"before", 3U}, {"later", 1U}}) {
        auto call = registration(name, 100);
        call.register_model().object_id(id);
        EXPECT_EQ(id_of(tracker.call(call, 0)), id);
    }
}

TEST(ScheduledTracker, takes_256_waiting_calls_and_refuses_the_next) {
    auto tracker = fresh();
    Poses poses;
    auto add = registration("a", 100);
    tracker.call(add, 0);
    for (int i = 0; i < 256; ++i) {
        auto set = pose_call("a", i);
        ASSERT_TRUE(tracker.call(set, 1000 + i).answer.ok()) << i;
    }
    auto further = pose_call("a", 1);
    EXPECT_EQ(tracker.call(further, 5000).answer.outcome.code(), v1::STATUS_LIMIT_EXCEEDED);
    tracker.advance(5000, poses);
    EXPECT_EQ(tracker.tracker().object("a")->start.pose.t_px.x(), 255);
}

TEST(ScheduledTracker, is_not_moved_in_time_by_an_event_outside_the_pixels) {
    auto tracker = fresh();
    Poses poses;
    auto add = registration("a", 100);
    tracker.call(add, 1000);
    const Event outside{2000, 304, 0, 1};
    tracker.process(std::span(&outside, 1), poses);
    EXPECT_EQ(tracker.waiting(), 1U);
    EXPECT_LT(tracker.tracker().last_t_us(), 1000);
}

TEST(ScheduledTracker, answers_an_unknown_operation) {
    auto tracker = fresh();
    v1::TrackerCall call;
    call._d() = static_cast<v1::TrackerCallKind>(77);
    const auto answer = tracker.call(call, 0).answer;
    EXPECT_EQ(answer.remote_exception, v1::REMOTE_UNKNOWN_OPERATION);
    EXPECT_THAT(answer.outcome.message().to_string(), HasSubstr("77 is not one of 0 to 9"));
}

TEST(ScheduledTracker, refuses_what_is_malformed_by_its_field) {
    const auto message = [](auto change) {
        auto tracker = fresh();
        auto call = registration("a", 100);
        change(call.register_model());
        const auto answer = tracker.call(call, 0).answer;
        EXPECT_EQ(answer.outcome.code(), v1::STATUS_INVALID_ARGUMENT);
        EXPECT_TRUE(tracker.tracker().object_names().empty());
        return answer.outcome.message().to_string();
    };
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(message([](auto& m) { m.points().resize(4097); }), HasSubstr("points: 4097"));
    EXPECT_THAT(message([](auto& m) { m.edges().resize(4097); }), HasSubstr("edges: 4097"));
    EXPECT_THAT(message([](auto& m) { m.parameters().resize(33); }), HasSubstr("parameters: 33"));
    EXPECT_THAT(message([](auto& m) { m.points()[3].x_px(static_cast<float>(nan)); }),
                HasSubstr("point"));
    EXPECT_THAT(message([](auto& m) { m.start().x_px(nan); }), HasSubstr("start."));
    EXPECT_THAT(message([](auto& m) { m.name("bad name"); }), HasSubstr("name"));
    EXPECT_THAT(message([](auto& m) { m.transform(static_cast<v1::TransformKind>(4)); }),
                HasSubstr("transform: 4 is not one of 0 to 3"));
    EXPECT_THAT(message([](auto& m) { m.estimator(static_cast<v1::EstimatorKind>(2)); }),
                HasSubstr("estimator: 2 is not one of 0 to 1"));
    EXPECT_THAT(message([](auto& m) { m.start().mode(static_cast<v1::StartMode>(9)); }),
                HasSubstr("start.mode: 9"));
}

TEST(ScheduledTracker, gives_the_id_there_for_the_same_content_and_refuses_other_content) {
    auto tracker = fresh();
    auto first = registration("a", 100);
    auto same = registration("a", 77);
    auto other = registration("a", 100, 30);
    EXPECT_EQ(tracker.call(first, 0).answer.result.register_model().object_id(), 1U);
    const auto again = tracker.call(same, 0).answer;
    EXPECT_TRUE(again.result.register_model().already_registered());
    EXPECT_EQ(again.result.register_model().object_id(), 1U);
    EXPECT_FALSE(again.changed);
    EXPECT_EQ(tracker.call(other, 0).answer.outcome.code(), v1::STATUS_ALREADY_EXISTS);
}

}  // namespace
}  // namespace pursuit::tracker
