// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/parameters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace pursuit::tracker {
namespace {

using testing::HasSubstr;

template <class Table, class Parameters>
void expect_usable(const Table& table, const Parameters& defaults) {
    EXPECT_LE(table.size(), 32U);
    for (const auto& line : table) {
        EXPECT_LE(line.name.size(), 47U) << line.name;
        EXPECT_LE(line.min, defaults.*(line.member)) << line.name;
        EXPECT_GE(line.max, defaults.*(line.member)) << line.name;
        EXPECT_FALSE(line.meaning.empty()) << line.name;
    }
}

TEST(Parameters, have_defaults_within_their_bounds_in_every_preset) {
    for (const Preset& preset : presets()) {
        expect_usable(object_parameter_table(), preset.object);
        expect_usable(tracker_parameter_table(), preset.tracker);
        expect_usable(strategy_parameter_table(), preset.strategy_parameters);
    }
}

TEST(Parameters, have_each_name_and_each_member_once) {
    std::set<std::string_view> names;
    for (const auto& line : object_parameter_table()) EXPECT_TRUE(names.insert(line.name).second);
    for (const auto& line : tracker_parameter_table()) EXPECT_TRUE(names.insert(line.name).second);
    EXPECT_EQ(names.size() * sizeof(double), sizeof(ObjectParameters) + sizeof(TrackerParameters));
    EXPECT_EQ(strategy_parameter_table().size() * sizeof(double), sizeof(StrategyParameters));
}

TEST(Parameters, fit_into_one_list_on_the_wire_with_the_tracker_s) {
    EXPECT_LE(object_parameter_table().size() + tracker_parameter_table().size(), 32U);
}

TEST(Parameters, are_set_and_listed_by_name) {
    ObjectParameters parameters;
    const std::vector<NamedValue> wanted{{"gate_px", 7.5}};
    ASSERT_TRUE(set(parameters, wanted));
    EXPECT_EQ(parameters.gate_px, 7.5);
    EXPECT_THAT(values(parameters), testing::Contains(NamedValue{"gate_px", 7.5}));
}

TEST(Parameters, given_twice_are_refused_and_set_nothing) {
    ObjectParameters parameters;
    const std::vector<NamedValue> wanted{{"gate_px", 3}, {"gate_px", 7}};
    const auto result = set(parameters, wanted);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().status, CallStatus::invalid_argument);
    EXPECT_THAT(result.error().message, HasSubstr("'gate_px': given twice"));
    EXPECT_EQ(parameters, ObjectParameters());
}

TEST(Parameters, name_field_and_bound_on_a_refusal_and_set_nothing) {
    for (const double bad : {-1.0, 1e9, std::nan("")}) {
        ObjectParameters parameters;
        const std::vector<NamedValue> wanted{{"gradient_position_gain", 0.2}, {"gate_px", bad}};
        const auto result = set(parameters, wanted);
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().status, CallStatus::invalid_argument);
        EXPECT_THAT(result.error().message, HasSubstr("gate_px"));
        EXPECT_THAT(result.error().message, HasSubstr("50"));
        EXPECT_EQ(parameters, ObjectParameters());
    }
}

TEST(Parameters, refuse_an_unknown_name) {
    StrategyParameters parameters;
    const std::vector<NamedValue> wanted{{"no_such_thing", 1}};
    ASSERT_FALSE(set(parameters, wanted));
    EXPECT_EQ(set(parameters, wanted).error().status, CallStatus::not_found);
    EXPECT_THAT(set(parameters, wanted).error().message, HasSubstr("no_such_thing"));
}

TEST(Parameters, of_the_paper_are_one_word) {
    const auto preset = find_preset("paper");
    ASSERT_TRUE(preset);
    EXPECT_EQ((*preset)->estimator, EstimatorKind::gradient);
    EXPECT_EQ((*preset)->object.gradient_position_gain, 0.1);
    EXPECT_EQ((*preset)->object.gradient_angle_gain_rad_px2, 2e-5);
    EXPECT_EQ((*preset)->object.gradient_scale_gain_1_px, 1e-5);
    EXPECT_FALSE(find_preset("papier"));
}

}  // namespace
}  // namespace pursuit::tracker
