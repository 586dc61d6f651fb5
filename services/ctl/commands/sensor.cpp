// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <memory>

#include "services/ctl/commands/dds_commands.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/commands/service_calls.hpp"

namespace pursuit::ctl {
namespace {

struct Options {
    DdsOptions dds;
    double rate = 1;
};

/// A call without a result: `fill` makes it.
Run define_call(CLI::App& app, std::shared_ptr<Options> options,
                std::function<void(v1::SensorCall&, const Options&)> fill) {
    add_dds_options(app, options->dds);
    return [options, fill] {
        v1::SensorRequest request;
        fill(request.call(), *options);
        const auto reply = call_sensor(options->dds, request);
        return reply ? exit_success : report(reply.error());
    };
}

}  // namespace

Run define_sensor_pause(CLI::App& app) {
    return define_call(app, std::make_shared<Options>(),
                       [](v1::SensorCall& call, const Options&) { call.pause({}); });
}

Run define_sensor_resume(CLI::App& app) {
    return define_call(app, std::make_shared<Options>(),
                       [](v1::SensorCall& call, const Options&) { call.resume({}); });
}

Run define_sensor_rate(CLI::App& app) {
    auto options = std::make_shared<Options>();
    app.add_option("rate", options->rate, "Times real time; 0: as fast as possible")->required();
    return define_call(app, options, [](v1::SensorCall& call, const Options& chosen) {
        v1::SetRate rate;
        rate.rate(chosen.rate);
        call.set_rate(rate);
    });
}

}  // namespace pursuit::ctl
