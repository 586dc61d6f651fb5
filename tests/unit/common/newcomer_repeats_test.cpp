// SPDX-License-Identifier: Apache-2.0
#include "services/common/newcomer_repeats.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pursuit {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t ms = 1'000'000;

RequestKey request_of(std::uint8_t participant, std::int64_t sequence) {
    RequestKey key;
    key.writer_guid[11] = participant;
    key.writer_guid[15] = 3;  // the writer within the participant
    key.sequence = sequence;
    return key;
}

void match(NewcomerRepeats& repeats, std::uint8_t participant, std::int64_t now_ns) {
    repeats.matched(participant_of(request_of(participant, 0)), now_ns);
}

TEST(NewcomerRepeats, give_what_a_newcomer_was_sent_once_more_after_250_ms) {
    NewcomerRepeats repeats;
    match(repeats, 1, 0);
    repeats.sent(request_of(1, 7), 10 * ms);
    EXPECT_THAT(repeats.due(259 * ms), IsEmpty());
    EXPECT_THAT(repeats.due(260 * ms), ElementsAre(request_of(1, 7)));
    EXPECT_THAT(repeats.due(900 * ms), IsEmpty());
}

TEST(NewcomerRepeats, leave_out_who_was_matched_a_second_ago_and_who_never_was) {
    NewcomerRepeats repeats;
    match(repeats, 1, 0);
    repeats.sent(request_of(1, 1), 999 * ms);
    repeats.sent(request_of(1, 2), 1000 * ms);
    repeats.sent(request_of(2, 3), 500 * ms);
    EXPECT_THAT(repeats.due(5000 * ms), ElementsAre(request_of(1, 1)));
}

TEST(NewcomerRepeats, give_a_reply_that_was_sent_twice_meanwhile_once) {
    NewcomerRepeats repeats;
    match(repeats, 1, 0);
    repeats.sent(request_of(1, 1), 10 * ms);
    repeats.sent(request_of(1, 1), 20 * ms);
    EXPECT_THAT(repeats.due(300 * ms), ElementsAre(request_of(1, 1)));
}

TEST(NewcomerRepeats, hold_at_most_256_replies_and_256_newcomers) {
    NewcomerRepeats replies;
    match(replies, 1, 0);
    for (std::int64_t i = 0; i < 300; ++i) replies.sent(request_of(1, i), 10 * ms);
    EXPECT_THAT(replies.due(300 * ms), SizeIs(NewcomerRepeats::most));

    NewcomerRepeats newcomers;
    match(newcomers, 1, 0);
    for (std::size_t i = 0; i < NewcomerRepeats::most; ++i) match(newcomers, 2, 1 * ms);
    newcomers.sent(request_of(1, 1), 10 * ms);
    newcomers.sent(request_of(2, 1), 10 * ms);
    EXPECT_THAT(newcomers.due(300 * ms), ElementsAre(request_of(2, 1)));
}

}  // namespace
}  // namespace pursuit
