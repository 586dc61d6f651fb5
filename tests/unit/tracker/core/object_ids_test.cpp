// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tracker/core/calls.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow;
using test::at;
using test::make_tracker;
using test::status_of;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(ObjectIds, give_ids_from_1_that_are_not_used_again) {
    Tracker tracker = make_tracker();
    EXPECT_EQ(tracker.register_object(at(arrow("a"), 1, 1))->object_id, 1U);
    EXPECT_EQ(tracker.register_object(at(arrow("b"), 1, 1))->object_id, 2U);
    ASSERT_TRUE(tracker.remove_object("b"));
    EXPECT_EQ(tracker.register_object(at(arrow("b"), 1, 1))->object_id, 3U);
    EXPECT_THAT(tracker.object_names(), ElementsAre("a", "b"));
    EXPECT_EQ(tracker.next_object_id(), 4U);
}

TEST(ObjectIds, take_an_id_of_the_caller_s_unless_it_was_used) {
    Tracker tracker = make_tracker();
    Registration registration = at(arrow("a"), 1, 1);
    registration.object_id = 17;
    EXPECT_EQ(tracker.register_object(registration)->object_id, 17U);
    registration.shape.name = "b";
    EXPECT_EQ(status_of(tracker.register_object(registration)), CallStatus::already_exists);
    registration.object_id = 5;  // passed over
    EXPECT_EQ(tracker.register_object(registration)->object_id, 5U);
    ASSERT_TRUE(tracker.remove_object("b"));
    EXPECT_EQ(status_of(tracker.register_object(registration)), CallStatus::already_exists);
    registration.object_id = 0;
    EXPECT_EQ(tracker.register_object(registration)->object_id, 18U);
}

TEST(ObjectIds, give_a_reserved_id_to_nobody_before_it_is_released) {
    Tracker tracker = make_tracker();
    tracker.reserve_id(1);
    Registration first = at(arrow("first"), 1, 1);
    first.object_id = 1;
    EXPECT_EQ(status_of(tracker.register_object(first)), CallStatus::already_exists);
    EXPECT_EQ(tracker.register_object(at(arrow("second"), 1, 1))->object_id, 2U);
    tracker.release_id(1);
    tracker.release_id(2);  // was not reserved
    EXPECT_EQ(tracker.register_object(first)->object_id, 1U);
    EXPECT_EQ(tracker.register_object(at(arrow("third"), 1, 1))->object_id, 3U);
}

TEST(ObjectIds, keep_so_many_ids_that_were_passed_over_and_no_more) {
    Tracker tracker = make_tracker();
    Registration registration = at(arrow("far"), 1, 1);
    registration.object_id = 5'000;
    ASSERT_TRUE(tracker.register_object(registration));
    registration.shape.name = "near";
    registration.object_id = 5'000 - 1'025;
    EXPECT_EQ(status_of(tracker.register_object(registration)), CallStatus::already_exists);
    registration.object_id = 5'000 - 1'024;
    EXPECT_TRUE(tracker.register_object(registration));
}

TEST(ObjectIds, refuse_an_id_that_would_leave_few_to_choose) {
    Tracker tracker = make_tracker();
    Registration registration = at(arrow("a"), 1, 1);
    for (const std::uint32_t id : {max_requested_id + 1, UINT32_MAX - 1, UINT32_MAX}) {
        registration.object_id = id;
        EXPECT_EQ(status_of(tracker.register_object(registration)), CallStatus::invalid_argument);
    }
    EXPECT_EQ(tracker.next_object_id(), 1U);
    registration.object_id = max_requested_id;
    EXPECT_EQ(tracker.register_object(registration)->object_id, max_requested_id);
    EXPECT_EQ(tracker.register_object(at(arrow("b"), 1, 1))->object_id, max_requested_id + 1);
}

TEST(ObjectIds, go_on_after_the_last_id_with_what_a_former_run_had) {
    Tracker tracker = make_tracker({.next_object_id = UINT32_MAX - 1});
    EXPECT_EQ(tracker.register_object(at(arrow("last"), 1, 1))->object_id, UINT32_MAX - 1);
    EXPECT_EQ(tracker.next_object_id(), no_object_id_left);
    Tracker restarted = make_tracker({.next_object_id = tracker.next_object_id()});
    Registration last = at(arrow("last"), 1, 1);
    last.object_id = UINT32_MAX - 1;
    EXPECT_EQ(restarted.register_object(last)->object_id, UINT32_MAX - 1);
    EXPECT_EQ(status_of(restarted.register_object(at(arrow("more"), 1, 1))),
              CallStatus::limit_exceeded);
}

TEST(ObjectIds, restore_former_ids_below_the_next_one) {
    Tracker tracker = make_tracker({.next_object_id = 9});
    Registration registration = at(arrow("a"), 1, 1);
    registration.object_id = 3;
    EXPECT_EQ(tracker.register_object(registration)->object_id, 3U);
    EXPECT_EQ(tracker.register_object(at(arrow("new"), 1, 1))->object_id, 9U);
    registration.shape.name = "b";
    registration.object_id = 7;
    EXPECT_EQ(tracker.register_object(registration)->object_id, 7U);
    EXPECT_THAT(tracker.object_names(), ElementsAre("a", "b", "new"));
    registration.shape.name = "c";
    EXPECT_EQ(status_of(tracker.register_object(registration)), CallStatus::already_exists);
}

TEST(ObjectIds, give_identical_content_its_id_again_whatever_the_start) {
    Tracker tracker = make_tracker();
    const auto first = tracker.register_object(at(arrow("a"), 1, 1));
    Registration again = at(arrow("a"), 50, 60);
    const auto second = tracker.register_object(again);
    ASSERT_TRUE(second);
    EXPECT_TRUE(second->already_registered);
    EXPECT_EQ(second->object_id, first->object_id);
    again.transform = TransformKind::similarity;
    EXPECT_EQ(status_of(tracker.register_object(again)), CallStatus::already_exists);
    again = at(arrow("a"), 1, 1);
    again.shape.points_px[0].x() += 1;
    EXPECT_EQ(status_of(tracker.register_object(again)), CallStatus::already_exists);
}

}  // namespace
}  // namespace pursuit::tracker
