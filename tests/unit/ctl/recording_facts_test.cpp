// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/recording_facts.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "services/sensor/formats/formats.hpp"
#include "tests/support/test_data.hpp"

namespace pursuit::ctl {
namespace {

RecordingFacts facts_of_text(const std::string& text) {
    auto recording = sensor::open_events(sensor::from_memory(
        "a.txt", {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
    return facts_of(**recording);
}

TEST(RecordingFacts, of_one_event_and_of_a_fault) {
    const auto facts = facts_of_text("0.000007 3 4 1\nbad\n");
    EXPECT_EQ(facts.events, 1U);
    EXPECT_EQ(facts.on_events, 1U);
    EXPECT_EQ(facts.first_t_us, 7);
    EXPECT_EQ(facts.last_t_us, 7);
    EXPECT_EQ(facts.longest_gap_us, 0);
    EXPECT_NE(facts.fault, "");
    EXPECT_EQ(rate_picture(facts), "█");
}

TEST(RecordingFacts, count_long_silences_and_exposure_measurements) {
    const auto facts = facts_of_text("0.1 1 1 1\n0.2 1 1 0\n0.299999 1 1 1\n0.6 1 1 1\n");
    EXPECT_EQ(facts.silences, 2U);
    EXPECT_EQ(facts.longest_gap_us, 300'001);
    const std::string atis("Event Stream\2\0\0\2\5\0\5\0\6\1\0\1\0\5\1\0\1\0\7\1\0\1\0", 35);
    auto recording = sensor::open_events(sensor::from_memory(
        "a.es", {reinterpret_cast<const std::uint8_t*>(atis.data()), atis.size()}));
    const auto of_atis = facts_of(**recording);
    EXPECT_EQ(of_atis.fault, "");
    EXPECT_EQ(of_atis.events, 1U);
    EXPECT_EQ(of_atis.exposures, 2U);
}

TEST(RecordingFacts, find_the_longest_silence_and_count_every_event_into_a_bin) {
    std::string text;
    for (int i = 0; i < 5000; ++i) {
        const int t_us = 100'000 + 37 * i + (i > 3000 ? 50'000 : 0);
        text += "0." + std::to_string(t_us) + " " + std::to_string(i % 200) + " 9 " +
                std::to_string(i % 2) + "\n";
    }
    const auto facts = facts_of_text(text);
    EXPECT_EQ(facts.fault, "");
    EXPECT_EQ(facts.events, 5000U);
    EXPECT_EQ(facts.on_events, 2500U);
    EXPECT_EQ(facts.longest_gap_us, 50'037);
    EXPECT_EQ(facts.gap_t_us, 100'000 + 37 * 3000);
    EXPECT_EQ(facts.x_max, 199);
    const auto& bins = facts.events_per_bin;
    EXPECT_EQ(std::accumulate(bins.begin(), bins.end(), std::uint64_t{0}), 5000U);
    EXPECT_LE(bins.size(), 64U);
    EXPECT_GT(bins.size(), 32U);
    EXPECT_GE(static_cast<std::int64_t>(bins.size()) * facts.bin_us,
              facts.last_t_us - facts.first_t_us);
}

}  // namespace
}  // namespace pursuit::ctl
