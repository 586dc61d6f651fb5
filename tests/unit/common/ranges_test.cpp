// SPDX-License-Identifier: Apache-2.0
#include "services/common/ranges.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "config.pb.h"
#include "model.pb.h"

namespace pursuit {
namespace {

/// What is wrong with a message that was made in memory; empty: nothing.
std::string range_fault(const google::protobuf::Message& message) {
    const auto ok = check_ranges(message, "made", nullptr);
    return ok ? "" : ok.error().message;
}

TEST(CheckRanges, finds_nothing_in_what_is_not_set_or_at_its_bound) {
    disk::TrackerConfig config;
    EXPECT_EQ(range_fault(config), "");
    config.mutable_dds()->set_domain(232);
    config.set_name(std::string(63, 'x'));
    EXPECT_EQ(range_fault(config), "");
}

TEST(CheckRanges, names_the_field_by_its_path_where_there_is_no_text) {
    disk::TrackerConfig config;
    config.mutable_dds()->set_domain(233);
    EXPECT_EQ(range_fault(config), "made: field dds.domain is 233, must be at most 232");
}

TEST(CheckRanges, refuses_a_service_s_name_that_would_be_a_pattern_of_partitions) {
    disk::SensorConfig config;
    config.set_name("front_left-2.b");
    EXPECT_EQ(range_fault(config), "");
    config.set_name("front*");
    EXPECT_EQ(range_fault(config),
              "made: field name is \"front*\", must be of A-Z, a-z, 0-9, '_', '.' and '-'");
}

TEST(CheckRanges, looks_into_every_message_of_a_repeated_field) {
    disk::Model model;
    for (const float x_px : {1.0F, 2.0F, std::nanf("")}) {
        auto* point = model.add_point();
        point->set_x_px(x_px);
        point->set_y_px(0);
    }
    EXPECT_EQ(range_fault(model), "made: field point.x_px is not a finite number");
}

}  // namespace
}  // namespace pursuit
