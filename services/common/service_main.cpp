// SPDX-License-Identifier: Apache-2.0
#include "services/common/service_main.hpp"

#include <signal.h>
#include <systemd/sd-daemon.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <iostream>
#include <vector>

#include "services/common/health.hpp"
#include "services/common/log.hpp"
#include "services/common/participant.hpp"
#include "services/common/settings.hpp"
#include "services/common/text_format.hpp"

namespace pursuit {
namespace {

constexpr auto tick_period = std::chrono::milliseconds(50);

/// SIGTERM, SIGINT and SIGHUP, taken by waiting for them. Must be made before any thread is.
class StopSignals {
 public:
    StopSignals() {
        ::sigemptyset(&set_);
        ::sigaddset(&set_, SIGTERM);
        ::sigaddset(&set_, SIGINT);
        // A terminal that is closed. What was started by nohup(1) ignores it, and is to go on.
        struct sigaction hangup {};
        ::sigaction(SIGHUP, nullptr, &hangup);
        if (hangup.sa_handler != SIG_IGN) ::sigaddset(&set_, SIGHUP);
        ::sigprocmask(SIG_BLOCK, &set_, nullptr);
        // A peer of a pipe or socket that goes away is an error value, not the end.
        ::signal(SIGPIPE, SIG_IGN);
    }
    /// The signal that came within `at_most`, or 0.
    int wait(std::chrono::nanoseconds at_most) const {
        const timespec time{static_cast<time_t>(at_most.count() / 1'000'000'000),
                            static_cast<long>(at_most.count() % 1'000'000'000)};
        const int signal = ::sigtimedwait(&set_, nullptr, &time);
        return signal > 0 ? signal : 0;
    }
    /// From here on a further signal ends the process at once.
    void release() const { ::sigprocmask(SIG_UNBLOCK, &set_, nullptr); }

 private:
    sigset_t set_{};
};

/// What the configuration of every service has, by the name of its field.
template <class Part>
const Part& part_of(const google::protobuf::Message& configuration, const char* name) {
    const auto* field = configuration.GetDescriptor()->FindFieldByName(name);
    return static_cast<const Part&>(
        configuration.GetReflection()->GetMessage(configuration, field));
}

int run(Service& service, const std::string& name, const FieldPlaces& places,
        const StopSignals& signals) {
    if (auto started = service.start(); !started) {
        if (const int signal = signals.wait(std::chrono::nanoseconds(0))) {
            spdlog::info("{} stops on SIG{} while it starts: {}", name, ::sigabbrev_np(signal),
                         started.error().message);
            service.stop();
            return exit_success;
        }
        const auto error = places.located(started.error(), "");
        spdlog::error("{} cannot start: {}", name, error.message);
        ::sd_notifyf(0, "STATUS=cannot start: %s", error.message.c_str());
        service.stop();
        return exit_failure;
    }
    std::string stalled;
    std::string status = service.status_line();
    ::sd_notifyf(0, "READY=1\nSTATUS=%s", status.c_str());
    spdlog::info("{} {} ready: {}", name, version(), status);
    while (!service.finished()) {
        if (const int signal = signals.wait(tick_period)) {
            spdlog::info("{} stops on SIG{}", name, ::sigabbrev_np(signal));
            break;
        }
        service.tick();
        if (auto now = service.stalled(); now != stalled) {
            stalled = std::move(now);
            if (stalled.empty()) {
                spdlog::info("{} gets on again", name);
            } else {
                spdlog::error("{}: {}; the watchdog is not told that all is well", name, stalled);
            }
        }
        if (stalled.empty()) ::sd_notify(0, "WATCHDOG=1");
        if (auto now = service.status_line(); now != status) {
            status = std::move(now);
            ::sd_notifyf(0, "STATUS=%s", status.c_str());
        }
    }
    ::sd_notify(0, "STOPPING=1");
    signals.release();
    const bool failed = service.failed();
    service.stop();
    // What is written last may fail too.
    return failed || service.failed() ? exit_failure : exit_success;
}

}  // namespace

bool may_go_on_starting() {
    // They are blocked, so that they wait to be taken.
    sigset_t pending{};
    ::sigpending(&pending);
    for (const int stop : {SIGTERM, SIGINT, SIGHUP}) {
        if (::sigismember(&pending, stop) == 1) return false;
    }
    ::sd_notify(0, "EXTEND_TIMEOUT_USEC=30000000");
    return true;
}

int service_main(int argc, char** argv, const std::string& name,
                 google::protobuf::Message& configuration,
                 const std::function<Result<std::unique_ptr<Service>>()>& make) {
    CLI::App app{name};
    std::string path;
    std::vector<std::string> settings;
    bool check = false;
    app.add_option("--config", path, "configuration file (Protobuf text)");
    app.add_option("--set", settings, "field=value, over the file")->take_all();
    app.add_flag("--check", check, "check the configuration and leave");
    app.set_version_flag("--version", version());
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exit_success : exit_configuration;
    }

    FieldPlaces places;
    Result<void> read;
    if (!path.empty()) read = read_text_file(path, configuration, &places);
    if (read) read = apply_settings(settings, configuration, &places);
    if (!read) {
        start_log({});
        spdlog::error("{}: {}", name, read.error().message);
        return exit_configuration;
    }
    start_log(part_of<disk::Log>(configuration, "log"));
    const StopSignals signals;
    try {
        auto service = Participant::check(part_of<disk::Dds>(configuration, "dds")).and_then(make);
        if (!service) {
            spdlog::error("{}: {}", name, places.located(service.error(), path).message);
            return exit_configuration;
        }
        if (check) {
            std::cout << "the configuration is good\n";
            return exit_success;
        }
        return run(**service, name, places, signals);
    } catch (const std::exception& error) {
        spdlog::critical("{} ends: {}", name, error.what());
        return exit_failure;
    }
}

}  // namespace pursuit
