// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/state_before.hpp"

#include <algorithm>
#include <iterator>

#include "services/recorder/replay/planned_call.hpp"

namespace pursuit::recorder {
namespace {

v1::TrackerRequest register_request(const v1::RegisteredModel& model) {
    v1::RegisterModel call;
    call.object_id(model.object_id());
    call.name(model.name());
    call.transform(model.transform());
    call.estimator(model.estimator());
    call.start(model.start());
    call.parameters(model.parameters());
    call.points(model.points());
    call.edges(model.edges());
    v1::TrackerRequest request;
    request.apply_at_us(model.effective_time_us());
    request.call().register_model(call);
    return request;
}

v1::TrackerRequest strategy_request(const v1::TrackerSettings& settings, std::int64_t time_us) {
    v1::SetOcclusionStrategy call;
    call.strategy(settings.strategy());
    call.parameters(settings.strategy_parameters());
    v1::TrackerRequest request;
    request.apply_at_us(time_us);
    request.call().set_occlusion_strategy(call);
    return request;
}

v1::TrackerRequest parameters_request(const v1::TrackerSettings& settings, std::int64_t time_us) {
    v1::SetParameters call;
    call.parameters(settings.parameters());
    v1::TrackerRequest request;
    request.apply_at_us(time_us);
    request.call().set_parameters(call);
    return request;
}

/// Whether each of `wanted` is there with that value.
bool contains(const std::vector<v1::NamedValue>& values,
              const std::vector<v1::NamedValue>& wanted) {
    return std::all_of(wanted.begin(), wanted.end(), [&](const v1::NamedValue& value) {
        return std::find(values.begin(), values.end(), value) != values.end();
    });
}

}  // namespace

void StateBefore::take(const v1::RegisteredModel& model, std::size_t stream) {
    if (!model.registered() || first_models_.size() >= most_planned_calls) return;
    first_models_.try_emplace({model.sensor_id(), model.object_id()}, model, stream);
}

void StateBefore::take(const v1::TrackerSettings& settings, std::size_t stream) {
    if (first_settings_.size() >= most_planned_calls) return;
    first_settings_.try_emplace(settings.instance().to_string(), settings, stream);
}

void StateBefore::take(const RecordedCall& call) {
    const auto& request = call.request.call();
    const auto kind = request._d();
    const auto& result = call.reply.result();
    const std::string instance = call.reply.header().instance_name().to_string();
    if (kind == v1::TRACKER_REGISTER_MODEL && result._d() == v1::TRACKER_REGISTER_MODEL &&
        !result.register_model().already_registered()) {
        registered_.emplace(instance, result.register_model().object_id());
    }
    const std::pair place(instance, call.reply.effective_time_us());
    if (kind == v1::TRACKER_SET_OCCLUSION_STRATEGY) {
        const auto& set = request.set_occlusion_strategy();
        settings_calls_.emplace(place, SettingsCall{set.strategy(), set.parameters()});
    } else if (kind == v1::TRACKER_SET_PARAMETERS &&
               request.set_parameters().name().to_string().empty()) {
        const auto& set = request.set_parameters();
        settings_calls_.emplace(place, SettingsCall{std::nullopt, set.parameters()});
    }
}

bool StateBefore::shows(const v1::TrackerSettings& settings, const SettingsCall& call) {
    if (!call.strategy) return contains(settings.parameters(), call.parameters);
    return settings.strategy() == *call.strategy &&
           contains(settings.strategy_parameters(), call.parameters);
}

bool StateBefore::was_called_for(const v1::TrackerSettings& settings) const {
    // All that a tracker does before its first event is at time 0. Its calls come after what is
    // told here, so that it does no harm where they brought it about.
    if (settings.effective_time_us() == 0) return false;
    const auto [first, last] = settings_calls_.equal_range(
        {settings.instance().to_string(), settings.effective_time_us()});
    return std::any_of(first, last, [&](const auto& each) { return shows(settings, each.second); });
}

std::vector<StateBefore::Call> StateBefore::calls(const SensorOf& sensor_of) const {
    std::set<std::pair<std::uint32_t, std::uint32_t>> registered;  // by sensor and object
    for (const auto& [instance, object_id] : registered_) {
        registered.emplace(sensor_of(instance), object_id);
    }
    std::vector<Call> models;
    // Of each sensor and stream the time of the first; settings hold no later, because they would
    // take from a model the parameters of its own.
    std::map<std::pair<std::uint32_t, std::size_t>, std::int64_t> first_us;
    for (const auto& [key, first] : first_models_) {
        const auto& [model, stream] = first;
        if (registered.contains(key)) continue;
        const auto time_us = model.effective_time_us();
        const auto known = first_us.try_emplace({model.sensor_id(), stream}, time_us).first;
        known->second = std::min(known->second, time_us);
        models.push_back({register_request(model), model.sensor_id(), "", stream});
    }
    std::vector<Call> calls;
    for (const auto& [instance, first] : first_settings_) {
        const auto& [settings, stream] = first;
        if (was_called_for(settings)) continue;
        const auto sensor_id = settings.sensor_id();
        const auto model = first_us.find({sensor_id, stream});
        const auto time_us = model == first_us.end()
                                 ? settings.effective_time_us()
                                 : std::min(settings.effective_time_us(), model->second);
        calls.push_back({strategy_request(settings, time_us), sensor_id, instance, stream});
        if (settings.parameters().empty()) continue;
        calls.push_back({parameters_request(settings, time_us), sensor_id, instance, stream});
    }
    std::move(models.begin(), models.end(), std::back_inserter(calls));
    return calls;
}

}  // namespace pursuit::recorder
