// SPDX-License-Identifier: Apache-2.0
#include "services/common/text_format.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config.pb.h"
#include "model.pb.h"

namespace pursuit {
namespace {

using testing::HasSubstr;

TEST(ParseText, reads_what_the_schema_allows) {
    disk::TrackerConfig config;
    ASSERT_TRUE(parse_text("name: \"front\"\npose_rate_hz: 500", "t.textproto", config));
    EXPECT_EQ(config.name(), "front");
    EXPECT_EQ(config.pose_rate_hz(), 500);
    EXPECT_EQ(config.max_objects(), 256U);
}

TEST(ParseText, names_file_line_and_field_of_an_unknown_field) {
    disk::TrackerConfig config;
    const auto ok = parse_text("name: \"front\"\npose_rate: 500", "t.textproto", config);
    ASSERT_FALSE(ok);
    EXPECT_THAT(ok.error().message, HasSubstr("t.textproto:2:"));
    EXPECT_THAT(ok.error().message, HasSubstr("\"pose_rate\""));
}

TEST(ParseText, names_file_line_and_field_of_a_wrong_type) {
    disk::TrackerConfig config;
    const auto ok = parse_text("\npose_rate_hz: \"fast\"", "t.textproto", config);
    ASSERT_FALSE(ok);
    EXPECT_THAT(ok.error().message, HasSubstr("t.textproto:2:"));
    EXPECT_THAT(ok.error().message, HasSubstr("pose_rate_hz"));
}

TEST(ParseText, names_file_line_and_field_of_a_value_out_of_range) {
    disk::TrackerConfig config;
    const auto ok = parse_text("name: \"a\"\n\ndds { domain: 233 }", "t.textproto", config);
    ASSERT_FALSE(ok);
    EXPECT_EQ(ok.error().message, "t.textproto:3: field dds.domain is 233, must be at most 232");
}

TEST(ParseText, refuses_nan_and_overlong_strings) {
    disk::TrackerConfig config;
    EXPECT_FALSE(parse_text("pose_rate_hz: nan", "t", config));
    const auto ok = parse_text("name: \"" + std::string(64, 'x') + "\"", "t", config);
    ASSERT_FALSE(ok);
    EXPECT_THAT(ok.error().message, HasSubstr("field name has 64 bytes, must have at most 63"));
}

TEST(ParseText, refuses_more_entries_than_the_schema_allows) {
    disk::Model model;
    std::string text = "name: \"m\"";
    for (int i = 0; i < 4097; ++i) text += " point { x_px: 1 y_px: 2 }";
    const auto ok = parse_text(text, "m", model);
    ASSERT_FALSE(ok);
    EXPECT_THAT(ok.error().message, HasSubstr("field point has 4097 entries"));
}

TEST(ParseText, refuses_a_missing_required_field) {
    disk::Model model;
    EXPECT_FALSE(parse_text("point { x_px: 1 }", "m", model));
}

TEST(ReadTextFile, says_which_file_is_missing) {
    disk::Model model;
    const auto ok = read_text_file("/nonexistent/m.textproto", model);
    ASSERT_FALSE(ok);
    EXPECT_THAT(ok.error().message, HasSubstr("/nonexistent/m.textproto: cannot open"));
}

}  // namespace
}  // namespace pursuit
