// SPDX-License-Identifier: Apache-2.0
#include "services/common/field_places.hpp"

#include <gtest/gtest.h>

#include "config.pb.h"
#include "services/common/settings.hpp"
#include "services/common/text_format.hpp"

namespace pursuit {
namespace {

/// Of what this text, called "t", gives a tracker's configuration.
FieldPlaces read(const std::string& text) {
    disk::TrackerConfig config;
    FieldPlaces places;
    EXPECT_TRUE(parse_text(text, "t", config, &places));
    return places;
}

TEST(FieldPlaces, are_the_lines_of_fields_and_of_every_entry_of_repeated_ones) {
    const FieldPlaces places = read(
        "strategy: 'weighted'\n"
        "parameter { name: 'a'\n value: 1 }\n"
        "model: 'x'\n"
        "parameter { name: 'b' value: 1 } model: 'y'\n"
        "dds {\n domain: 7 }");
    EXPECT_EQ(places.of("strategy"), "t:1");
    EXPECT_EQ(places.of("parameter[0]"), "t:2");
    EXPECT_EQ(places.of("parameter[0].value"), "t:3");
    EXPECT_EQ(places.of("parameter[1].name"), "t:5");
    EXPECT_EQ(places.of("model[0]"), "t:4");
    EXPECT_EQ(places.of("model[1]"), "t:5");
    EXPECT_EQ(places.of("dds.domain"), "t:7");
}

TEST(FieldPlaces, of_a_field_that_is_not_there_is_that_of_what_it_would_be_in) {
    const FieldPlaces places = read("\ndds { domain: 7 }");
    EXPECT_EQ(places.of("dds.initial_peer[3]"), "t:2");
    EXPECT_EQ(places.of("preset"), "");
    EXPECT_EQ(places.of(""), "");
}

TEST(FieldPlaces, of_the_entries_of_a_list_in_brackets_is_its_beginning) {
    const FieldPlaces places = read("name: 'a'\nmodel: ['x',\n'y']");
    EXPECT_EQ(places.of("model[0]"), "t:2");
    EXPECT_EQ(places.of("model[1]"), "t:2");
}

TEST(FieldPlaces, of_what_a_setting_has_changed_is_the_setting) {
    disk::TrackerConfig config;
    FieldPlaces places;
    ASSERT_TRUE(parse_text("parameter { name: 'a' value: 1 } dds { domain: 7 } model: 'x'", "t",
                           config, &places));
    ASSERT_TRUE(apply_settings({"parameter[0].value=2", "parameter={name: 'b' value: 1}",
                                "dds={domain: 8}", "model=y", "preset=p"},
                               config, &places));
    EXPECT_EQ(places.of("parameter[0].name"), "t:1");
    EXPECT_EQ(places.of("parameter[0].value"), "--set parameter[0].value=2");
    EXPECT_EQ(places.of("parameter[1].value"), "--set parameter={name: 'b' value: 1}");
    EXPECT_EQ(places.of("dds.domain"), "--set dds={domain: 8}");
    EXPECT_EQ(places.of("model[0]"), "t:1");
    EXPECT_EQ(places.of("model[1]"), "--set model=y");
    EXPECT_EQ(places.of("preset"), "--set preset=p");
}

TEST(FieldPlaces, stand_in_front_of_an_error_of_the_field_and_else_what_is_given) {
    FieldPlaces places;
    places.note("strategy", "t:3");
    EXPECT_EQ(places.located(fail_field("strategy", ": unknown").value(), "t").message,
              "t:3: field strategy: unknown");
    EXPECT_EQ(places.located(fail_field("preset", ": unknown").value(), "t").message,
              "t: field preset: unknown");
    EXPECT_EQ(places.located({"no model is named"}, "").message, "no model is named");
}

}  // namespace
}  // namespace pursuit
