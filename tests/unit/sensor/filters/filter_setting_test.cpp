// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/filter_setting.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/sensor/filters/filter_rule.hpp"

namespace pursuit::sensor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(FilterSetting, is_read_from_text_and_written_back) {
    const auto setting = parse_filter("  undistort a=1.5  b=-2 file=/a b/lens.textproto \n");
    ASSERT_TRUE(setting) << setting.error().message;
    EXPECT_EQ(setting->filter, "undistort");
    EXPECT_EQ(setting->file, "/a b/lens.textproto");
    EXPECT_THAT(setting->parameters,
                ElementsAre(FilterSetting::Value{"a", 1.5}, FilterSetting::Value{"b", -2}));
    EXPECT_EQ(*parse_filter(to_text(*setting)), *setting);
    for (const char* bad : {"", " ", "refractory period_us", "refractory =1",
                            "refractory a=", "refractory a=1x", "pixel_mask file= "}) {
        EXPECT_FALSE(parse_filter(bad)) << bad;
    }
}

TEST(FilterSetting, that_does_not_fit_is_refused_by_name_and_bound) {
    const auto message_of = [](const std::string& text) {
        return make_filter(*parse_filter(text), small).error().message;
    };
    EXPECT_THAT(message_of("refractory period_us=0"),
                HasSubstr("period_us is 0, must be a whole number from 1 to 1000000000 us"));
    EXPECT_THAT(message_of("refractory period_us=1.5"), HasSubstr("whole number"));
    EXPECT_THAT(message_of("refractory period_us=nan"), HasSubstr("period_us is nan"));
    EXPECT_THAT(message_of("refractory period_us=5 period_us=6"), HasSubstr("given twice"));
    EXPECT_THAT(message_of("refractory period=1"), HasSubstr("parameter period is unknown"));
    EXPECT_THAT(message_of("no_such"), HasSubstr("no filter is named \"no_such\""));
    EXPECT_THAT(message_of("pixel_mask"), HasSubstr("file is missing"));
    EXPECT_THAT(message_of("polarity file=a"), HasSubstr("takes none"));
}

}  // namespace
}  // namespace pursuit::sensor
