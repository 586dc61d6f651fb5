// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/recorded_calls.hpp"

#include <gtest/gtest.h>

#include "services/recorder/replay/planned_call.hpp"

namespace pursuit::recorder {
namespace {

v1::TrackerRequest removal(std::uint32_t number) {
    v1::TrackerRequest request;
    request.header().request_id().sequence_low(number);
    request.call().remove_model({});
    return request;
}

v1::TrackerReply removed(std::uint32_t number) {
    v1::TrackerReply reply;
    reply.header().related_request_id().sequence_low(number);
    reply.result().remove_model({});
    return reply;
}

TEST(RecordedCalls, are_given_once_when_the_second_half_is_heard_whichever_it_is) {
    RecordedCalls calls;
    EXPECT_FALSE(calls.take(removal(1)));
    EXPECT_FALSE(calls.take(removed(2), 3));
    const auto second = calls.take(removal(2));
    const auto first = calls.take(removed(1), 4);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(second->request, removal(2));
    EXPECT_EQ(second->reply, removed(2));
    EXPECT_EQ(second->stream, 3U);
    EXPECT_EQ(second->order, 1U);
    EXPECT_EQ(first->stream, 4U);
    EXPECT_EQ(first->order, 2U);
    EXPECT_FALSE(calls.take(removal(1)));
    EXPECT_FALSE(calls.take(removed(1), 0));
    EXPECT_EQ(calls.unanswered(), 0U);
}

TEST(RecordedCalls, leave_out_what_only_asks) {
    RecordedCalls calls;
    v1::TrackerRequest request;
    request.call().get_status({});
    v1::TrackerReply reply;
    reply.result().get_status({});
    EXPECT_FALSE(calls.take(request));
    EXPECT_FALSE(calls.take(reply, 0));
    EXPECT_EQ(calls.unanswered(), 0U);
}

TEST(RecordedCalls, are_counted_where_the_tracker_obeyed_and_the_request_was_not_heard) {
    RecordedCalls calls;
    auto refused = removed(1);
    refused.outcome().code(v1::STATUS_NOT_FOUND);
    calls.take(refused, 0);
    v1::TrackerReply known;
    known.header().related_request_id().sequence_low(4);
    v1::RegisterModelResult was_there;
    was_there.already_registered(true);
    known.result().register_model(was_there);
    calls.take(known, 0);
    EXPECT_EQ(calls.unasked(), 0U);
    calls.take(removed(2), 0);
    calls.take(removed(3), 0);
    EXPECT_EQ(calls.unasked(), 2U);
    EXPECT_TRUE(calls.take(removal(3)));
    EXPECT_EQ(calls.unasked(), 1U);
}

TEST(RecordedCalls, say_when_there_are_more_than_are_remembered) {
    RecordedCalls calls;
    for (std::uint32_t i = 0; i < most_planned_calls; ++i) calls.take(removal(i));
    EXPECT_FALSE(calls.too_many());
    EXPECT_FALSE(calls.take(removal(most_planned_calls)));
    EXPECT_TRUE(calls.too_many());
    EXPECT_EQ(calls.unanswered(), most_planned_calls);
    EXPECT_TRUE(calls.take(removed(0), 0));
}

}  // namespace
}  // namespace pursuit::recorder
