// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/fault.hpp"

#include <gtest/gtest.h>

namespace pursuit::recorder::mcap {
namespace {

TEST(McapFaultLog, a_file_without_faults_is_closed_at_its_end) {
    FaultLog log(OnDamage::stop);
    EXPECT_EQ(log.condition(), Condition::reading);
    log.close();
    EXPECT_EQ(log.condition(), Condition::closed);
}

TEST(McapFaultLog, damage_ends_the_reading_or_is_noted_as_was_asked_for) {
    FaultLog stops(OnDamage::stop);
    stops.damage(4, "this");
    EXPECT_EQ(stops.condition(), Condition::damaged);

    FaultLog goes_on(OnDamage::skip_chunk);
    goes_on.damage(4, "this");
    EXPECT_EQ(goes_on.condition(), Condition::reading);
    goes_on.close();
    EXPECT_EQ(goes_on.condition(), Condition::damaged);
    ASSERT_EQ(goes_on.faults().size(), 1U);
    EXPECT_EQ(to_string(goes_on.faults()[0], "run.mcap"), "run.mcap: byte 4: this");
}

TEST(McapFaultLog, keeps_the_first_hundred_faults) {
    FaultLog log(OnDamage::skip_chunk);
    for (std::uint64_t i = 0; i < 101; ++i) log.damage(i, "this");
    log.end({Condition::cut, 101, "that"});
    EXPECT_EQ(log.faults().size(), 100U);
    EXPECT_EQ(log.faults().back().offset, 99U);
    EXPECT_EQ(log.condition(), Condition::cut);
}

}  // namespace
}  // namespace pursuit::recorder::mcap
