// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/call_dispatch.hpp"

#include "services/tracker/tracker_wire.hpp"

namespace pursuit::tracker {
namespace {

CallAnswer refusal(const CallError& error) {
    return tracker::refusal(status_code(error.status), error.message);
}

/// The answer to a change that gives no value.
CallAnswer done(const CallResult<void>& changed, v1::TrackerResult result) {
    if (!changed) return refusal(changed.error());
    CallAnswer answer;
    answer.result = std::move(result);
    answer.changed = true;
    return answer;
}

CallAnswer register_model(Tracker& tracker, const v1::RegisterModel& call) {
    const auto registration = registration_of(call);
    if (!registration) return refusal(registration.error());
    const auto registered = tracker.register_object(*registration);
    if (!registered) return refusal(registered.error());
    v1::RegisterModelResult result;
    result.object_id(registered->object_id);
    result.already_registered(registered->already_registered);
    CallAnswer answer;
    answer.result.register_model(result);
    answer.changed = !registered->already_registered;
    return answer;
}

CallAnswer update_model(Tracker& tracker, const v1::UpdateModel& call) {
    const auto update = update_of(call);
    if (!update) return refusal(update.error());
    v1::TrackerResult result;
    result.update_model({});
    return done(tracker.update_object(*update), std::move(result));
}

CallAnswer remove_model(Tracker& tracker, const v1::ModelName& call) {
    v1::TrackerResult result;
    result.remove_model({});
    return done(tracker.remove_object(call.name().to_string()), std::move(result));
}

CallAnswer list_models(const Tracker& tracker) {
    v1::ModelNames names;
    for (const auto& name : tracker.object_names()) names.names().emplace_back(name);
    CallAnswer answer;
    answer.result.list_models(std::move(names));
    return answer;
}

CallAnswer get_model(const Tracker& tracker, const v1::ModelName& call, std::uint32_t sensor_id) {
    const auto object = tracker.object(call.name().to_string());
    if (!object) return refusal(object.error());
    CallAnswer answer;
    answer.result.get_model(registered_model(sensor_id, *object));
    return answer;
}

CallAnswer set_pose(Tracker& tracker, const v1::SetPose& call) {
    const auto start = start_of(call.pose(), "pose.");
    if (!start) return refusal(start.error());
    v1::TrackerResult result;
    result.set_pose({});
    return done(tracker.set_pose(call.name().to_string(), *start), std::move(result));
}

CallAnswer set_strategy(Tracker& tracker, const v1::SetOcclusionStrategy& call) {
    const auto kind = strategy_of(call.strategy());
    if (!kind) return refusal(kind.error());
    const auto values = values_of(call.parameters());
    if (!values) return refusal(values.error());
    v1::TrackerResult result;
    result.set_occlusion_strategy({});
    return done(tracker.set_strategy(*kind, *values), std::move(result));
}

CallAnswer get_strategy(const Tracker& tracker, const ServiceIdentity& identity) {
    CallAnswer answer;
    answer.result.get_occlusion_strategy(
        tracker_settings(identity.instance, identity.sensor_id, tracker.settings()));
    return answer;
}

CallAnswer set_parameters(Tracker& tracker, const v1::SetParameters& call) {
    const auto values = values_of(call.parameters());
    if (!values) return refusal(values.error());
    v1::TrackerResult result;
    result.set_parameters({});
    return done(tracker.set_parameters(call.name().to_string(), *values), std::move(result));
}

}  // namespace

CallAnswer refusal(v1::StatusCode code, const std::string& message, v1::RemoteException exception) {
    CallAnswer answer;
    answer.remote_exception = exception;
    answer.outcome.code(code);
    answer.outcome.message(message.substr(0, 511));
    return answer;
}

CallAnswer dispatch(Tracker& tracker, const v1::TrackerCall& call,
                    const ServiceIdentity& identity) {
    switch (call._d()) {
        case v1::TRACKER_REGISTER_MODEL:
            return register_model(tracker, call.register_model());
        case v1::TRACKER_UPDATE_MODEL:
            return update_model(tracker, call.update_model());
        case v1::TRACKER_REMOVE_MODEL:
            return remove_model(tracker, call.remove_model());
        case v1::TRACKER_LIST_MODELS:
            return list_models(tracker);
        case v1::TRACKER_GET_MODEL:
            return get_model(tracker, call.get_model(), identity.sensor_id);
        case v1::TRACKER_SET_POSE:
            return set_pose(tracker, call.set_pose());
        case v1::TRACKER_SET_OCCLUSION_STRATEGY:
            return set_strategy(tracker, call.set_occlusion_strategy());
        case v1::TRACKER_GET_OCCLUSION_STRATEGY:
            return get_strategy(tracker, identity);
        case v1::TRACKER_SET_PARAMETERS:
            return set_parameters(tracker, call.set_parameters());
        case v1::TRACKER_GET_STATUS:
            break;
    }
    return tracker::refusal(v1::STATUS_UNSUPPORTED,
                            "call: " + std::to_string(static_cast<std::uint32_t>(call._d())) +
                                " is not one of 0 to " +
                                std::to_string(static_cast<std::uint32_t>(v1::TRACKER_GET_STATUS)),
                            v1::REMOTE_UNKNOWN_OPERATION);
}

CallResult<Tracker> trial_of(const Tracker& tracker) {
    TrackerOptions options = tracker.options();
    options.next_object_id = tracker.next_object_id();
    options.only_checks = true;
    auto made = Tracker::create(options);
    if (!made) return made;
    const Settings settings = tracker.settings();
    for (const auto& set : {
             made->set_strategy(settings.strategy, values(settings.strategy_parameters)),
             made->set_parameters("", values(settings.tracker)),
             made->set_parameters("", values(settings.new_objects)),
         }) {
        if (!set) return tl::unexpected(set.error());
    }
    for (const auto& object : tracker.objects()) {
        const auto registered =
            made->register_object({object.object_id, object.shape, object.transform,
                                   object.estimator, object.start, values(object.parameters)});
        if (!registered) return tl::unexpected(registered.error());
    }
    made->take_ids_of(tracker);
    return made;
}

}  // namespace pursuit::tracker
