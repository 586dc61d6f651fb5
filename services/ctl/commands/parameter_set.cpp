// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "services/ctl/commands/dds_commands.hpp"
#include "services/ctl/commands/named_values.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/commands/service_calls.hpp"

namespace pursuit::ctl {
namespace {

struct ParameterSetOptions {
    DdsOptions dds;
    std::string model;
    std::vector<std::string> settings;
    std::int64_t apply_at_us = 0;
};

int parameter_set(const ParameterSetOptions& options) {
    auto values = named_values(options.settings);
    if (!values) return report(values.error());
    v1::SetParameters call;
    call.name(options.model);
    call.parameters(std::move(*values));
    v1::TrackerRequest request;
    request.apply_at_us(options.apply_at_us);
    request.call().set_parameters(std::move(call));
    const auto reply = call_tracker(options.dds, request);
    if (!reply) return report(reply.error());
    std::printf("set, from %lld us on\n", static_cast<long long>(reply->effective_time_us()));
    return exit_success;
}

}  // namespace

Run define_parameter_set(CLI::App& app) {
    auto options = std::make_shared<ParameterSetOptions>();
    add_dds_options(app, options->dds);
    app.add_option("--model", options->model, "Of this object; without it the tracker's");
    app.add_option("settings", options->settings, "name=value")->required();
    app.add_option("--apply-at", options->apply_at_us, "Sensor time, us; 0: now");
    return [options] { return parameter_set(*options); };
}

}  // namespace pursuit::ctl
