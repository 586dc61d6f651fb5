// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/state_before.hpp"

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

v1::TrackerRequest strategy_request(const v1::TrackerSettings& settings) {
    v1::SetOcclusionStrategy call;
    call.strategy(settings.strategy());
    call.parameters(settings.strategy_parameters());
    v1::TrackerRequest request;
    request.apply_at_us(settings.effective_time_us());
    request.call().set_occlusion_strategy(call);
    return request;
}

v1::TrackerRequest parameters_request(const v1::TrackerSettings& settings) {
    v1::SetParameters call;
    call.parameters(settings.parameters());
    v1::TrackerRequest request;
    request.apply_at_us(settings.effective_time_us());
    request.call().set_parameters(call);
    return request;
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
    if (kind == v1::TRACKER_REGISTER_MODEL && result._d() == v1::TRACKER_REGISTER_MODEL &&
        !result.register_model().already_registered()) {
        registered_.insert(result.register_model().object_id());
    }
    const bool of_all =
        kind == v1::TRACKER_SET_PARAMETERS && request.set_parameters().name().to_string().empty();
    if (kind == v1::TRACKER_SET_OCCLUSION_STRATEGY || of_all) {
        settings_called_.insert(call.reply.effective_time_us());
    }
}

std::vector<StateBefore::Call> StateBefore::calls() const {
    std::vector<Call> calls;
    for (const auto& [instance, first] : first_settings_) {
        const auto& [settings, stream] = first;
        if (settings_called_.contains(settings.effective_time_us())) continue;
        const auto sensor_id = settings.sensor_id();
        calls.push_back({strategy_request(settings), sensor_id, instance, stream});
        if (settings.parameters().empty()) continue;
        calls.push_back({parameters_request(settings), sensor_id, instance, stream});
    }
    for (const auto& [key, first] : first_models_) {
        const auto& [model, stream] = first;
        if (registered_.contains(model.object_id())) continue;
        calls.push_back({register_request(model), model.sensor_id(), "", stream});
    }
    return calls;
}

}  // namespace pursuit::recorder
