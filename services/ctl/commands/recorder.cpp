// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <memory>

#include "services/ctl/commands/dds_commands.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/commands/service_calls.hpp"

namespace pursuit::ctl {
namespace {

struct RecorderOptions {
    DdsOptions dds;
    double rate = 1;
};

/// A call without a result: `fill` makes it.
Run define_call(CLI::App& app, std::shared_ptr<RecorderOptions> options,
                std::function<void(v1::RecorderCall&, const RecorderOptions&)> fill) {
    add_dds_options(app, options->dds);
    return [options, fill] {
        v1::RecorderRequest request;
        fill(request.call(), *options);
        const auto reply = call_recorder(options->dds, request);
        return reply ? exit_success : report(reply.error());
    };
}

}  // namespace

Run define_recorder_pause(CLI::App& app) {
    return define_call(app, std::make_shared<RecorderOptions>(),
                       [](v1::RecorderCall& call, const RecorderOptions&) { call.pause({}); });
}

Run define_recorder_resume(CLI::App& app) {
    return define_call(app, std::make_shared<RecorderOptions>(),
                       [](v1::RecorderCall& call, const RecorderOptions&) { call.resume({}); });
}

Run define_recorder_new_file(CLI::App& app) {
    return define_call(app, std::make_shared<RecorderOptions>(),
                       [](v1::RecorderCall& call, const RecorderOptions&) { call.new_file({}); });
}

Run define_recorder_rate(CLI::App& app) {
    auto options = std::make_shared<RecorderOptions>();
    app.add_option("rate", options->rate, "Of a replay, times real time; 0: as fast as possible")
        ->required();
    return define_call(app, options, [](v1::RecorderCall& call, const RecorderOptions& chosen) {
        v1::ReplayRate rate;
        rate.rate(chosen.rate);
        call.set_rate(rate);
    });
}

}  // namespace pursuit::ctl
