// SPDX-License-Identifier: Apache-2.0
#include "services/common/settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config.pb.h"
#include "services/common/text_format.hpp"

namespace pursuit {
namespace {

using testing::HasSubstr;

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

TEST(ApplySettings, takes_a_whole_message_in_braces) {
    disk::TrackerConfig config;
    ASSERT_TRUE(apply_settings({R"(parameter={name: "coast_s" value: 2})", "dds={domain: 7}",
                                "parameter={name: 'gate_px' value: 5}"},
                               config));
    EXPECT_EQ(config.dds().domain(), 7U);
    ASSERT_EQ(config.parameter_size(), 2);
    EXPECT_EQ(config.parameter(0).name(), "coast_s");
    EXPECT_EQ(config.parameter(1).value(), 5);
    for (const auto* wrong : {"parameter={name: 'a' valu: 1}", "parameter={name: 'a'", "name={}"}) {
        const auto ok = apply_settings({wrong}, config);
        ASSERT_FALSE(ok) << wrong;
        EXPECT_THAT(ok.error().message, HasSubstr(wrong));
    }
}

TEST(ApplySettings, replaces_what_is_there_but_gives_no_field_twice_itself) {
    disk::TrackerConfig config;
    ASSERT_TRUE(
        apply_settings({"name=a", "name=b", "dds={domain: 7}", "dds={heartbeat_ms: 9}"}, config));
    EXPECT_EQ(config.name(), "b");
    EXPECT_EQ(config.dds().domain(), 7U);
    EXPECT_EQ(config.dds().heartbeat_ms(), 9U);
    EXPECT_FALSE(apply_settings({"dds={domain: 7 domain: 8}"}, config));
}

TEST(ApplySettings, names_the_field_that_a_message_in_braces_lacks) {
    disk::TrackerConfig config;
    const auto ok = apply_settings({"parameter={name: 'coast_s'}"}, config);
    ASSERT_FALSE(ok);
    EXPECT_EQ(ok.error().message,
              "--set parameter={name: 'coast_s'}: field parameter[0].value is missing");
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

}  // namespace
}  // namespace pursuit
