// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>

#include "services/ctl/commands/dds_commands.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/commands/service_calls.hpp"
#include "services/tracker/model_file.hpp"
#include "services/tracker/tracker_wire.hpp"

namespace pursuit::ctl {
namespace {

struct PoseSetOptions {
    DdsOptions dds;
    std::string pose;
    bool search = false;
    std::int64_t apply_at_us = 0;
};

int pose_set(const PoseSetOptions& options) {
    const auto argument = tracker::parse_model_argument(options.pose);
    if (!argument) return report(argument.error());
    if (argument->start.has_value() == options.search) {
        return report(Error{"\"" + options.pose + "\": either NAME@x,y,theta or --search"});
    }
    tracker::Start start;
    start.search = options.search;
    if (argument->start) start.pose = *argument->start;
    v1::SetPose call;
    call.name(argument->path);
    call.pose(tracker::start_pose(start));
    v1::TrackerRequest request;
    request.apply_at_us(options.apply_at_us);
    request.call().set_pose(call);
    const auto reply = call_tracker(options.dds, request);
    if (!reply) return report(reply.error());
    std::printf("%s begins anew, from %lld us on\n", argument->path.c_str(),
                static_cast<long long>(reply->effective_time_us()));
    return exit_success;
}

}  // namespace

Run define_pose_set(CLI::App& app) {
    auto options = std::make_shared<PoseSetOptions>();
    add_dds_options(app, options->dds);
    app.add_option("pose", options->pose, "NAME@x,y,theta[,scale] of a registered model, px, rad")
        ->required();
    app.add_flag("--search", options->search, "Let the tracker find it");
    app.add_option("--apply-at", options->apply_at_us, "Sensor time, us; 0: now");
    return [options] { return pose_set(*options); };
}

}  // namespace pursuit::ctl
