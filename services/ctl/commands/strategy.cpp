// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "services/ctl/commands/dds_commands.hpp"
#include "services/ctl/commands/named_values.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/commands/service_calls.hpp"
#include "services/tracker/core/kinds.hpp"

namespace pursuit::ctl {
namespace {

struct StrategyOptions {
    DdsOptions dds;
    std::string strategy;
    std::vector<std::string> settings;
    std::int64_t apply_at_us = 0;
};

std::string name_of(v1::OcclusionStrategy strategy) {
    return std::string(tracker::to_string(static_cast<tracker::StrategyKind>(strategy)));
}

int strategy_get(const StrategyOptions& options) {
    v1::TrackerRequest request;
    request.call().get_occlusion_strategy({});
    const auto reply = call_tracker(options.dds, request);
    if (!reply) return report(reply.error());
    const auto& settings = reply->result().get_occlusion_strategy();
    std::printf("%s\n%s", name_of(settings.strategy()).c_str(),
                listed(settings.strategy_parameters()).c_str());
    return exit_success;
}

int strategy_set(const StrategyOptions& options) {
    const auto kind = tracker::parse_strategy(options.strategy);
    if (!kind) {
        return report(Error{"\"" + options.strategy + "\" is not " + tracker::strategy_names()});
    }
    auto values = named_values(options.settings);
    if (!values) return report(Error{"--set " + values.error().message});
    v1::SetOcclusionStrategy call;
    call.strategy(static_cast<v1::OcclusionStrategy>(*kind));
    call.parameters(std::move(*values));
    v1::TrackerRequest request;
    request.apply_at_us(options.apply_at_us);
    request.call().set_occlusion_strategy(std::move(call));
    const auto reply = call_tracker(options.dds, request);
    if (!reply) return report(reply.error());
    std::printf("%s, from %lld us on\n", options.strategy.c_str(),
                static_cast<long long>(reply->effective_time_us()));
    return exit_success;
}

int strategy_list() {
    for (int kind = 0; kind <= static_cast<int>(tracker::StrategyKind::probabilistic); ++kind) {
        std::printf("%s\n", name_of(static_cast<v1::OcclusionStrategy>(kind)).c_str());
    }
    return exit_success;
}

}  // namespace

Run define_strategy_get(CLI::App& app) {
    auto options = std::make_shared<StrategyOptions>();
    add_dds_options(app, options->dds);
    return [options] { return strategy_get(*options); };
}

Run define_strategy_set(CLI::App& app) {
    auto options = std::make_shared<StrategyOptions>();
    add_dds_options(app, options->dds);
    app.add_option("strategy", options->strategy, tracker::strategy_names())->required();
    app.add_option("--set", options->settings, "name=value: a parameter of the strategy")
        ->take_all();
    app.add_option("--apply-at", options->apply_at_us, "Sensor time, us; 0: now");
    return [options] { return strategy_set(*options); };
}

Run define_strategy_list(CLI::App&) { return strategy_list; }

}  // namespace pursuit::ctl
