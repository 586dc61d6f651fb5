// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "services/ctl/commands/dds_commands.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/commands/service_calls.hpp"
#include "services/sensor/filter_wire.hpp"
#include "services/sensor/filters/filters.hpp"

namespace pursuit::ctl {
namespace {

struct SensorOptions {
    DdsOptions dds;
    double rate = 1;
    std::vector<std::string> filters;
    bool none = false;
};

/// A call without a result: `fill` makes it.
Run define_call(CLI::App& app, std::shared_ptr<SensorOptions> options,
                std::function<void(v1::SensorCall&, const SensorOptions&)> fill) {
    add_dds_options(app, options->dds);
    return [options, fill] {
        v1::SensorRequest request;
        fill(request.call(), *options);
        const auto reply = call_sensor(options->dds, request);
        return reply ? exit_success : report(reply.error());
    };
}

std::string range_of(const sensor::FilterParameter& parameter) {
    std::string text = sensor::shown(parameter.min) + " to " + sensor::shown(parameter.max);
    if (!parameter.unit.empty() && parameter.unit != "1") text += " " + std::string(parameter.unit);
    return text;
}

int list_filter_kinds() {
    for (const auto& kind : sensor::filter_kinds()) {
        std::printf("%s: %s\n", std::string(kind.name).c_str(), std::string(kind.what).c_str());
        for (const auto& parameter : kind.parameters) {
            std::printf("    %-14s %-24s default %-10s %s\n", std::string(parameter.name).c_str(),
                        range_of(parameter).c_str(), sensor::shown(parameter.standard).c_str(),
                        std::string(parameter.meaning).c_str());
        }
        if (kind.takes_file) std::printf("    file=PATH      idl/filters.proto; on its host\n");
    }
    return exit_success;
}

int set_filters(const SensorOptions& options) {
    if (options.filters.empty() != options.none) {
        return report({options.none ? "--none goes with no filter" : "no filter; --none for none"});
    }
    v1::SetFilters call;
    for (const auto& text : options.filters) {
        const auto setting = sensor::parse_filter(text);
        if (!setting) return report(setting.error());
        const auto wire = sensor::to_wire(*setting);
        if (!wire) return report(wire.error());
        call.filters().push_back(*wire);
    }
    v1::SensorRequest request;
    request.call().set_filters(call);
    const auto reply = call_sensor(options.dds, request);
    return reply ? exit_success : report(reply.error());
}

}  // namespace

Run define_sensor_filters(CLI::App& app) {
    auto options = std::make_shared<SensorOptions>();
    add_dds_options(app, options->dds);
    app.add_option("filter", options->filters,
                   "\"NAME parameter=number … file=PATH\", in the order they apply; all there are");
    app.add_flag("--none", options->none, "No filter any more");
    return [options] { return set_filters(*options); };
}

Run define_sensor_filter_kinds(CLI::App&) { return list_filter_kinds; }

Run define_sensor_pause(CLI::App& app) {
    return define_call(app, std::make_shared<SensorOptions>(),
                       [](v1::SensorCall& call, const SensorOptions&) { call.pause({}); });
}

Run define_sensor_resume(CLI::App& app) {
    return define_call(app, std::make_shared<SensorOptions>(),
                       [](v1::SensorCall& call, const SensorOptions&) { call.resume({}); });
}

Run define_sensor_rate(CLI::App& app) {
    auto options = std::make_shared<SensorOptions>();
    app.add_option("rate", options->rate, "Times real time; 0: as fast as possible")->required();
    return define_call(app, options, [](v1::SensorCall& call, const SensorOptions& chosen) {
        v1::SetRate rate;
        rate.rate(chosen.rate);
        call.set_rate(rate);
    });
}

}  // namespace pursuit::ctl
