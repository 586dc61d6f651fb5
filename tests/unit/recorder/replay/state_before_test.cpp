// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/state_before.hpp"

#include <gtest/gtest.h>

#include "services/recorder/replay/planned_call.hpp"

namespace pursuit::recorder {
namespace {

v1::RegisteredModel model_told(std::uint32_t object_id, const std::string& name) {
    v1::RegisteredModel model;
    model.sensor_id(1);
    model.object_id(object_id);
    model.name(name);
    model.registered(true);
    model.effective_time_us(500);
    return model;
}

v1::TrackerSettings settings_told(std::int64_t effective_us, bool with_parameters) {
    v1::TrackerSettings settings;
    settings.instance("left");
    settings.sensor_id(1);
    settings.effective_time_us(effective_us);
    if (with_parameters) settings.parameters().push_back({});
    return settings;
}

/// A call that registered that object; the tracker may have had it already.
RecordedCall registering(std::uint32_t object_id, bool already_registered) {
    RecordedCall call;
    call.request.call().register_model({});
    v1::RegisterModelResult result;
    result.object_id(object_id);
    result.already_registered(already_registered);
    call.reply.result().register_model(result);
    return call;
}

std::vector<std::string> names_of(const StateBefore& state) {
    std::vector<std::string> names;
    for (const auto& call : state.calls()) names.push_back(name_of(call.request));
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
    const auto calls = state.calls();
    EXPECT_EQ(calls[0].instance, "left");
    EXPECT_EQ(calls[0].stream, 1U);
    EXPECT_EQ(calls[2].sensor_id, 1U);
    EXPECT_EQ(calls[2].instance, "");
    EXPECT_EQ(calls[2].stream, 2U);
    EXPECT_EQ(calls[2].request.call().register_model().object_id(), 3U);
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

TEST(StateBefore, leaves_out_settings_that_a_recorded_call_made) {
    StateBefore state;
    RecordedCall call;
    call.request.call().set_occlusion_strategy({});
    call.reply.effective_time_us(40);
    state.take(call);
    state.take(settings_told(40, true), 0);
    EXPECT_EQ(names_of(state), Texts{});
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
