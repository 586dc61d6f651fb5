// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/state_before.hpp"

#include <gtest/gtest.h>

#include "services/recorder/replay/planned_call.hpp"

namespace pursuit::recorder {
namespace {

/// Each tracker is named after its sensor.
std::uint32_t sensor_of(const std::string& instance) { return instance == "left" ? 1 : 2; }

v1::RegisteredModel model_told(std::uint32_t object_id, const std::string& name,
                               std::uint32_t sensor_id = 1) {
    v1::RegisteredModel model;
    model.sensor_id(sensor_id);
    model.object_id(object_id);
    model.name(name);
    model.registered(true);
    model.effective_time_us(500);
    return model;
}

v1::NamedValue coast_s(double value) {
    v1::NamedValue named;
    named.name("coast_s");
    named.value(value);
    return named;
}

/// Of the tracker "left"; coast_s is 2 where there are parameters.
v1::TrackerSettings settings_told(std::int64_t effective_us, bool with_parameters) {
    v1::TrackerSettings settings;
    settings.instance("left");
    settings.sensor_id(1);
    settings.effective_time_us(effective_us);
    settings.strategy(v1::STRATEGY_WEIGHTED);
    if (with_parameters) settings.parameters().push_back(coast_s(2));
    return settings;
}

/// A call that registered that object; the tracker may have had it already.
RecordedCall registering(std::uint32_t object_id, bool already_registered,
                         const std::string& instance = "left") {
    RecordedCall call;
    call.request.call().register_model({});
    v1::RegisterModelResult result;
    result.object_id(object_id);
    result.already_registered(already_registered);
    call.reply.header().instance_name(instance);
    call.reply.result().register_model(result);
    return call;
}

/// A call on the tracker as a whole.
RecordedCall setting(v1::OcclusionStrategy strategy, std::int64_t effective_us,
                     const std::string& instance = "left") {
    RecordedCall call;
    v1::SetOcclusionStrategy set;
    set.strategy(strategy);
    call.request.call().set_occlusion_strategy(set);
    call.reply.header().instance_name(instance);
    call.reply.effective_time_us(effective_us);
    return call;
}

RecordedCall setting_coast_s(double value, std::int64_t effective_us) {
    RecordedCall call;
    v1::SetParameters set;
    set.parameters().push_back(coast_s(value));
    call.request.call().set_parameters(set);
    call.reply.header().instance_name("left");
    call.reply.effective_time_us(effective_us);
    return call;
}

std::vector<std::string> names_of(const StateBefore& state) {
    std::vector<std::string> names;
    for (const auto& call : state.calls(sensor_of)) names.push_back(name_of(call.request));
    return names;
}

using Texts = std::vector<std::string>;

TEST(StateBefore, of_a_recording_that_tells_nothing_is_empty) {
    EXPECT_EQ(names_of(StateBefore()), Texts{});
}

TEST(StateBefore, brings_about_settings_then_models_each_as_told_first) {
    StateBefore state;
    state.take(model_told(3, "car"), 2);
    state.take(model_told(3, "renamed"), 2);
    state.take(settings_told(40, true), 1);
    state.take(settings_told(90, true), 1);
    EXPECT_EQ(names_of(state), (Texts{"set occlusion strategy at 40 us", "set parameters  at 40 us",
                                      "register model car at 500 us"}));
    const auto calls = state.calls(sensor_of);
    EXPECT_EQ(calls[0].instance, "left");
    EXPECT_EQ(calls[0].stream, 1U);
    EXPECT_EQ(calls[2].sensor_id, 1U);
    EXPECT_EQ(calls[2].instance, "");
    EXPECT_EQ(calls[2].stream, 2U);
    EXPECT_EQ(calls[2].request.call().register_model().object_id(), 3U);
}

TEST(StateBefore,
     brings_about_settings_no_later_than_the_models_whose_own_parameters_they_would_take) {
    StateBefore state;
    state.take(model_told(3, "car"), 0);
    auto earlier = model_told(4, "van");
    earlier.effective_time_us(300);
    state.take(earlier, 0);
    state.take(settings_told(900, true), 0);
    EXPECT_EQ(names_of(state),
              (Texts{"set occlusion strategy at 300 us", "set parameters  at 300 us",
                     "register model car at 500 us", "register model van at 300 us"}));
}

TEST(StateBefore, sets_no_parameters_where_none_were_told) {
    StateBefore state;
    state.take(settings_told(40, false), 0);
    EXPECT_EQ(names_of(state), Texts{"set occlusion strategy at 40 us"});
}

TEST(StateBefore, leaves_out_what_a_recorded_call_registered) {
    StateBefore state;
    state.take(registering(3, false));
    state.take(registering(4, true));
    state.take(model_told(3, "car"), 0);
    state.take(model_told(4, "van"), 0);
    EXPECT_EQ(names_of(state), Texts{"register model van at 500 us"});
}

TEST(StateBefore, keeps_a_model_whose_id_a_call_gave_to_another_of_another_tracker) {
    StateBefore state;
    state.take(model_told(1, "car", 1), 0);
    state.take(registering(1, false, "right"));
    state.take(model_told(1, "van", 2), 0);
    EXPECT_EQ(names_of(state), Texts{"register model car at 500 us"});
}

const auto of_40_us = Texts{"set occlusion strategy at 40 us", "set parameters  at 40 us"};
const auto of_the_start = Texts{"set occlusion strategy at 0 us", "set parameters  at 0 us"};

TEST(StateBefore, leaves_out_settings_that_a_recorded_call_made) {
    StateBefore strategy;
    strategy.take(setting(v1::STRATEGY_WEIGHTED, 40));
    strategy.take(settings_told(40, true), 0);
    EXPECT_EQ(names_of(strategy), Texts{});
    StateBefore parameters;
    parameters.take(setting_coast_s(2, 40));
    parameters.take(settings_told(40, true), 0);
    EXPECT_EQ(names_of(parameters), Texts{});
}

TEST(StateBefore, keeps_settings_that_do_not_show_the_call_of_the_same_time) {
    StateBefore strategy;
    strategy.take(settings_told(40, true), 0);
    strategy.take(setting(v1::STRATEGY_CLOSEST, 40));
    EXPECT_EQ(names_of(strategy), of_40_us);
    StateBefore parameters;
    parameters.take(settings_told(40, true), 0);
    parameters.take(setting_coast_s(3, 40));
    EXPECT_EQ(names_of(parameters), of_40_us);
}

TEST(StateBefore, keeps_settings_where_the_call_was_on_another_tracker) {
    StateBefore state;
    state.take(settings_told(40, true), 0);
    state.take(setting(v1::STRATEGY_WEIGHTED, 40, "right"));
    EXPECT_EQ(names_of(state), of_40_us);
}

TEST(StateBefore, keeps_the_settings_of_a_tracker_whose_calls_came_before_its_first_event) {
    StateBefore state;
    state.take(settings_told(0, true), 0);
    state.take(setting_coast_s(3, 0));
    state.take(setting(v1::STRATEGY_WEIGHTED, 0));  // as it was: nothing tells the two apart
    EXPECT_EQ(names_of(state), of_the_start);
}

TEST(StateBefore, holds_no_model_that_was_told_as_removed) {
    StateBefore state;
    auto model = model_told(3, "car");
    model.registered(false);
    state.take(model, 0);
    EXPECT_EQ(names_of(state), Texts{});
}

}  // namespace
}  // namespace pursuit::recorder
