// SPDX-License-Identifier: Apache-2.0
#include "services/common/text_format.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

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

TEST(ApplySettings, sets_nested_and_plain_fields_and_appends_to_repeated_ones) {
    disk::TrackerConfig config;
    ASSERT_TRUE(
        apply_settings({"dds.domain=7", "name=front", "model=a b.textproto", "model=c"}, config));
    EXPECT_EQ(config.dds().domain(), 7U);
    EXPECT_EQ(config.name(), "front");
    ASSERT_EQ(config.model_size(), 2);
    EXPECT_EQ(config.model(0), "a b.textproto");
}

TEST(ApplySettings, changes_the_numbered_message_of_a_repeated_field) {
    disk::TrackerConfig config;
    ASSERT_TRUE(parse_text("parameter { name: 'a' value: 1 } parameter { name: 'b' value: 2 }", "c",
                           config));
    ASSERT_TRUE(apply_settings({"parameter[1].value=7"}, config));
    EXPECT_EQ(config.parameter_size(), 2);
    EXPECT_EQ(config.parameter(0).value(), 1);
    EXPECT_EQ(config.parameter(1).value(), 7);
    for (const auto* wrong : {"parameter[2].value=1", "parameter[-1].value=1", "parameter[.value=1",
                              "parameter[].value=1", "parameter[1x].value=1", "parameter[0]=1",
                              "dds[0].domain=1", "model[0]=a", "parameter[0].valu=1", "a..b=1"}) {
        const auto ok = apply_settings({wrong}, config);
        ASSERT_FALSE(ok) << wrong;
        EXPECT_THAT(ok.error().message, HasSubstr(wrong));
    }
}

TEST(ApplySettings, names_the_setting_that_is_wrong) {
    disk::TrackerConfig config;
    for (const auto* wrong :
         {"dds.domain", "=1", "dds=1", "name.x=1", "typo=1", "dds.domain=-1", "pose_rate_hz=0"}) {
        const auto ok = apply_settings({wrong}, config);
        ASSERT_FALSE(ok) << wrong;
        EXPECT_THAT(ok.error().message, HasSubstr(wrong));
    }
}

TEST(ReadTextFile, says_which_file_is_missing) {
    disk::Model model;
    const auto ok = read_text_file("/nonexistent/m.textproto", model);
    ASSERT_FALSE(ok);
    EXPECT_THAT(ok.error().message, HasSubstr("/nonexistent/m.textproto: cannot open"));
}

TEST(WriteFileAtomically, leaves_the_new_content_and_no_temporary_file) {
    const auto folder = std::filesystem::temp_directory_path() / "pursuit_text_format_test";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directory(folder);
    const auto path = (folder / "a").string();
    ASSERT_TRUE(write_file_atomically(path, "one"));
    ASSERT_TRUE(write_file_atomically(path, "two"));
    std::ifstream in(path);
    std::string content;
    in >> content;
    EXPECT_EQ(content, "two");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
    std::filesystem::remove_all(folder);
}

TEST(WriteFileAtomically, says_why_it_cannot_write) {
    const auto ok = write_file_atomically("/nonexistent/a", "x");
    ASSERT_FALSE(ok);
    EXPECT_THAT(ok.error().message, HasSubstr("/nonexistent/a"));
}

}  // namespace
}  // namespace pursuit
