// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/commands/dds_options.hpp"

#include "services/common/log.hpp"
#include "services/common/participant.hpp"

namespace pursuit::ctl {

void add_dds_options(CLI::App& app, DdsOptions& options) {
    app.add_option("--domain", options.domain, "DDS domain")
        ->capture_default_str()
        ->check(CLI::Range(0, 232));
    app.add_option("--name", options.name, "Of the sensor; without it whichever answers");
    app.add_flag("--loopback", options.loopback, "This host only, without multicast");
    app.add_option("--timeout", options.timeout_ms, "How long to wait for an answer, ms")
        ->capture_default_str()
        ->check(CLI::Range(1, 3'600'000));
}

Result<std::unique_ptr<Participant>> join(const DdsOptions& options) {
    disk::Log log;
    log.set_level(disk::Log::WARNING);
    start_log(log);
    disk::Dds settings;
    settings.set_domain(options.domain);
    settings.set_loopback_only(options.loopback);
    auto participant = Participant::create(settings, "pursuitctl", "");
    if (!participant || options.name.empty()) return participant;
    // Not the default partition, where every service is.
    auto publisher = (*participant)->publisher().get_qos();
    publisher.partition().push_back(options.name.c_str());
    (*participant)->publisher().set_qos(publisher);
    auto subscriber = (*participant)->subscriber().get_qos();
    subscriber.partition().push_back(options.name.c_str());
    (*participant)->subscriber().set_qos(subscriber);
    return participant;
}

std::string where(const DdsOptions& options) {
    const std::string domain = "in domain " + std::to_string(options.domain);
    return options.name.empty() ? domain : "of sensor " + options.name + " " + domain;
}

}  // namespace pursuit::ctl
