// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/start_settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace pursuit::tracker {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(ConfiguredTracker, names_the_field_that_it_cannot_take) {
    const auto error_of = [](const disk::TrackerConfig& config) {
        const auto made = configured_tracker(config, 1);
        return made ? Error{} : made.error();
    };
    disk::TrackerConfig config;
    const auto add = [&](const std::string& name, double value) {
        auto* parameter = config.add_parameter();
        parameter->set_name(name);
        parameter->set_value(value);
    };
    add("gate_px", 5);
    add("no_such", 1);
    EXPECT_EQ(error_of(config).field, "parameter[1]");
    EXPECT_THAT(error_of(config).message, StartsWith("field parameter[1]: "));
    config.mutable_parameter()->RemoveLast();
    add(std::string(strategy_parameter_table().front().name), -1e9);
    EXPECT_EQ(error_of(config).field, "parameter[1]");
    config.clear_parameter();
    add("gate_px", 3);
    add("gate_px", 7);
    EXPECT_EQ(error_of(config).field, "parameter[1]");
    EXPECT_THAT(error_of(config).message, HasSubstr("given twice"));
    config.clear_parameter();
    config.set_strategy("no_such");
    EXPECT_EQ(error_of(config).field, "strategy");
    config.set_preset("no_such");
    EXPECT_EQ(error_of(config).field, "preset");
}

TEST(ConfiguredModels, names_the_entry_that_it_cannot_read) {
    const pursuit::test::TemporaryFolder folder;
    disk::TrackerConfig config;
    config.add_model(folder.file("van.csv", "x_px,y_px\n0,0\n9,0\n0,9\n"));
    config.add_model(folder.path("none.csv"));
    const auto models = configured_models(config);
    ASSERT_FALSE(models);
    EXPECT_EQ(models.error().field, "model[1]");
    EXPECT_THAT(models.error().message, StartsWith("field model[1]: " + folder.path("none.csv")));
}

TEST(ConfiguredModels, refuses_two_of_one_name_and_names_both) {
    const pursuit::test::TemporaryFolder folder;
    const std::string triangle = "x_px,y_px\n0,0\n9,0\n0,9\n";
    const auto van = folder.file("van.csv", triangle);
    const auto car = folder.file("car.csv", triangle);
    for (const std::string& second :
         {van + "@136,138,0", van + "@36,138,0", folder.file("model_van.csv", triangle)}) {
        disk::TrackerConfig config;
        config.add_model(van + "@36,138,0");
        config.add_model(car + "@10,10,0");
        EXPECT_TRUE(configured_models(config));
        config.add_model(second);
        const auto models = configured_models(config);
        ASSERT_FALSE(models);
        EXPECT_EQ(models.error().field, "model[2]");
        EXPECT_THAT(models.error().message,
                    AllOf(HasSubstr("two models are named van, " + van + "@36,138,0 and " + second),
                          HasSubstr("another name")));
    }
}

}  // namespace
}  // namespace pursuit::tracker
