// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "services/ctl/commands/dds_commands.hpp"
#include "services/ctl/commands/named_values.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/commands/service_calls.hpp"
#include "services/tracker/start_settings.hpp"
#include "services/tracker/tracker_wire.hpp"

namespace pursuit::ctl {
namespace {

struct RegisterOptions {
    DdsOptions dds;
    std::string model;
    std::string transform;
    std::string estimator;
    std::vector<std::string> settings;
    std::uint32_t object_id = 0;
    std::int64_t apply_at_us = 0;
    bool search = false;
};

tracker::EstimatorKind default_estimator() { return tracker::presets().front().estimator; }

Result<v1::TrackerRequest> register_request(const RegisterOptions& options) {
    const auto transform = tracker::parse_transform(options.transform);
    if (!transform && !options.transform.empty()) {
        return fail("--transform: \"" + options.transform + "\" is not " +
                    tracker::transform_names());
    }
    auto estimator = tracker::parse_estimator(options.estimator);
    // A request names its estimator, and no topic tells which preset the tracker has.
    if (options.estimator.empty()) estimator = default_estimator();
    if (!estimator) {
        return fail("--estimator: \"" + options.estimator + "\" is not " +
                    tracker::estimator_names());
    }
    auto registration = tracker::configured_model(options.model, *estimator);
    if (!registration) return tl::unexpected(registration.error());
    if (transform) registration->transform = *transform;
    auto values = named_values(options.settings);
    if (!values) return fail("--set " + values.error().message);
    registration->object_id = options.object_id;
    if (options.search) registration->start = {true, {}, {}};
    auto call = tracker::register_model(*registration);
    call.parameters(std::move(*values));
    v1::TrackerRequest request;
    request.apply_at_us(options.apply_at_us);
    request.call().register_model(std::move(call));
    return request;
}

int model_register(const RegisterOptions& options) {
    auto request = register_request(options);
    if (!request) return report(request.error());
    const std::string name = request->call().register_model().name().to_string();
    const auto reply = call_tracker(options.dds, *request);
    if (!reply) return report(reply.error());
    const auto& result = reply->result().register_model();
    if (result.already_registered()) {
        std::printf("%s was already object %u; it goes on from where it is\n", name.c_str(),
                    result.object_id());
        return exit_success;
    }
    std::printf("%s is object %u, from %lld us on\n", name.c_str(), result.object_id(),
                static_cast<long long>(reply->effective_time_us()));
    return exit_success;
}

struct NameOptions {
    DdsOptions dds;
    std::string name;
};

int model_list(const NameOptions& options) {
    v1::TrackerRequest request;
    request.call().list_models({});
    const auto reply = call_tracker(options.dds, request);
    if (!reply) return report(reply.error());
    for (const auto& name : reply->result().list_models().names()) {
        std::printf("%s\n", name.c_str());
    }
    return exit_success;
}

v1::ModelName model_name(const std::string& name) {
    v1::ModelName wire;
    wire.name(name);
    return wire;
}

int model_remove(const NameOptions& options) {
    v1::TrackerRequest request;
    request.call().remove_model(model_name(options.name));
    const auto reply = call_tracker(options.dds, request);
    if (!reply) return report(reply.error());
    std::printf("%s is removed, from %lld us on\n", options.name.c_str(),
                static_cast<long long>(reply->effective_time_us()));
    return exit_success;
}

int model_show(const NameOptions& options) {
    v1::TrackerRequest request;
    request.call().get_model(model_name(options.name));
    const auto reply = call_tracker(options.dds, request);
    if (!reply) return report(reply.error());
    const auto& model = reply->result().get_model();
    const auto& start = model.start();
    const auto transform = static_cast<tracker::TransformKind>(model.transform());
    const auto estimator = static_cast<tracker::EstimatorKind>(model.estimator());
    std::printf("%s: object %u, %zu points, %zu edges\n", model.name().c_str(), model.object_id(),
                model.points().size(), model.edges().size());
    std::printf("%s by the %s estimator, as it is since %lld us\n",
                std::string(tracker::to_string(transform)).c_str(),
                std::string(tracker::to_string(estimator)).c_str(),
                static_cast<long long>(model.effective_time_us()));
    if (start.mode() == v1::START_SEARCH) {
        std::printf("searched for\n");
    } else {
        std::printf("began at x %.3f px, y %.3f px, A [%.6f %.6f; %.6f %.6f]\n", start.x_px(),
                    start.y_px(), start.a00(), start.a01(), start.a10(), start.a11());
    }
    std::printf("parameters\n%s", listed(model.parameters()).c_str());
    return exit_success;
}

/// A sub-command with a model's name as its only argument.
Run define_by_name(CLI::App& app, int (*run)(const NameOptions&)) {
    auto options = std::make_shared<NameOptions>();
    add_dds_options(app, options->dds);
    app.add_option("model", options->name, "Name of a registered model")->required();
    return [options, run] { return run(*options); };
}

}  // namespace

Run define_model_register(CLI::App& app) {
    auto options = std::make_shared<RegisterOptions>();
    add_dds_options(app, options->dds);
    app.add_option("model", options->model, "PATH[@x,y,theta[,scale]], px and rad")->required();
    app.add_option("--transform", options->transform, tracker::transform_names());
    app.add_option("--estimator", options->estimator,
                   tracker::estimator_names() +
                       "; without: " + std::string(tracker::to_string(default_estimator())) +
                       ", whatever the tracker's preset");
    app.add_option("--set", options->settings, "name=value: a parameter of the object")->take_all();
    app.add_option("--object-id", options->object_id, "0: the tracker chooses; at most 2147483647");
    app.add_option("--apply-at", options->apply_at_us, "Sensor time, us; 0: now");
    app.add_flag("--search", options->search, "Let the tracker find it");
    return [options] { return model_register(*options); };
}

Run define_model_list(CLI::App& app) {
    auto options = std::make_shared<NameOptions>();
    add_dds_options(app, options->dds);
    return [options] { return model_list(*options); };
}

Run define_model_show(CLI::App& app) { return define_by_name(app, model_show); }
Run define_model_remove(CLI::App& app) { return define_by_name(app, model_remove); }

}  // namespace pursuit::ctl
