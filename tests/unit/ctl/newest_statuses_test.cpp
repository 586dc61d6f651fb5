// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/newest_statuses.hpp"

#include <gtest/gtest.h>

namespace pursuit::ctl {
namespace {

using namespace std::chrono_literals;
using Shown = std::map<std::string, std::string>;

/// Statuses are words here, and writers have numbers from 1.
class NewestStatusesOf : public ::testing::Test {
 protected:
    void tell(const std::string& instance, const std::string& status, int writer) {
        statuses_.put(instance, status, writer, now_);
    }
    Shown shown() { return statuses_.at(now_); }

    NewestStatuses<std::string, int> statuses_;
    std::chrono::steady_clock::time_point now_{1h};
};

TEST_F(NewestStatusesOf, services_are_those_that_told_theirs_within_three_seconds) {
    tell("left", "running", 1);
    tell("right", "running", 2);
    now_ += 2s;
    tell("right", "lost", 2);
    EXPECT_EQ(shown(), (Shown{{"left", "running"}, {"right", "lost"}}));
    now_ += 1s;
    EXPECT_EQ(shown(), (Shown{{"right", "lost"}}));
}

TEST_F(NewestStatusesOf, a_service_started_again_are_its_own_whatever_was_said_late) {
    tell("left", "old", 1);
    now_ += 500ms;
    tell("left", "new", 2);
    tell("left", "last words", 1);
    EXPECT_EQ(shown(), (Shown{{"left", "new"}}));
}

TEST_F(NewestStatusesOf, one_that_is_mistaken_for_the_predecessor_are_seen_when_the_other_is_gone) {
    tell("left", "new", 2);
    tell("left", "last words", 1);
    for (int i = 0; i < 3; ++i) {
        now_ += 1s;
        tell("left", "running", 2);
    }
    EXPECT_EQ(shown(), (Shown{{"left", "running"}}));
}

}  // namespace
}  // namespace pursuit::ctl
