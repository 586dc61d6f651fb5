// SPDX-License-Identifier: Apache-2.0
#include "services/common/text_format.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config.pb.h"
#include "model.pb.h"
#include "scene.pb.h"

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

TEST(ParseText, names_file_line_and_field_of_a_missing_required_field) {
    disk::Model model;
    const auto error_of = [&](const std::string& text) {
        return parse_text(text, "m", model).error().message;
    };
    EXPECT_EQ(error_of("name: 'm'\npoint { x_px: 1 y_px: 2 }\npoint {\n x_px: 1 }"),
              "m:3: field point[1].y_px is missing");
    EXPECT_EQ(error_of("point { x_px: 1 y_px: 2 }"), "m: field name is missing");
}

TEST(ParseText, refuses_a_field_given_twice_that_is_not_repeated) {
    disk::TrackerConfig config;
    for (const auto* twice : {"name: 'a'\nname: 'b'", "dds { domain: 1 }\ndds { domain: 2 }",
                              "dds { domain: 1\n domain: 2 }"}) {
        const auto ok = parse_text(twice, "t", config);
        ASSERT_FALSE(ok) << twice;
        EXPECT_THAT(ok.error().message, HasSubstr("t:2:"));
        EXPECT_THAT(ok.error().message, HasSubstr("is specified multiple times"));
    }
}

TEST(ParseText, names_the_line_of_a_value_out_of_range_in_a_list_in_brackets) {
    disk::Scene scene;
    const auto ok = parse_text("name: 's'\nlayer { polygon { xy_px: [1, 2e5] } }", "s", scene);
    ASSERT_FALSE(ok);
    EXPECT_EQ(ok.error().message,
              "s:2: field layer.polygon.xy_px is 200000, must be at most 100000");
}

TEST(ReadTextFile, says_which_file_is_missing) {
    disk::Model model;
    const auto ok = read_text_file("/nonexistent/m.textproto", model);
    ASSERT_FALSE(ok);
    EXPECT_THAT(ok.error().message, HasSubstr("/nonexistent/m.textproto: cannot open"));
}

}  // namespace
}  // namespace pursuit
