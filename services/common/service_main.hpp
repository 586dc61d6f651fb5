// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <google/protobuf/message.h>

#include <functional>
#include <memory>
#include <string>

#include "services/common/result.hpp"

namespace pursuit {

/// What a service process runs.
///
///   start() ──► tick() every 50 ms ──► stop()      (also when start() failed half-way)
///
/// Threads: all of it is called on the main thread.
class Service {
 public:
    virtual ~Service() = default;
    /// Brings up own entities, configuration and stores; never waits for peers.
    virtual Result<void> start() = 0;
    /// Publishes status when due, and looks after the rest. Must not block for more than 0.5 s.
    virtual void tick() = 0;
    /// True when there is nothing more to do: the process leaves with exit code 0, or 1 if failed.
    virtual bool finished() const = 0;
    /// Asked before stop() and after it.
    virtual bool failed() const = 0;
    /// One line for systemd's STATUS: what it does, or what it waits for.
    virtual std::string status_line() const = 0;
    /// Names a thread that does not get on any more. systemd's watchdog is not pinged then, and
    /// restarts the service if that lasts. Empty: all is well. Waiting for peers, for the disk or
    /// for the next event is no stall.
    virtual std::string stalled() const { return ""; }
    /// Ends every thread and closes every file; at most 2 s.
    virtual void stop() = 0;
};

/// For a start() that may take longer than systemd waits, before each step: asks for 30 s more.
/// False once SIGTERM or SIGINT has come: it is to give up then.
bool may_go_on_starting();

/// Exit codes; RestartPreventExitStatus=78 keeps systemd from restarting on a bad configuration.
enum ExitCode : int { exit_success = 0, exit_failure = 1, exit_configuration = 78 };

/// The main() of a service: reads --config FILE and --set field=value into `configuration`,
/// starts the log, makes the service, tells systemd READY when start() has returned, ticks until
/// SIGTERM, SIGINT or SIGHUP or until it has finished, and stops it. A second signal ends at once.
/// A start() that gives up on a signal is no failure. `make` refuses a configuration by an Error;
/// the process then ends with exit_configuration.
int service_main(int argc, char** argv, const std::string& name,
                 google::protobuf::Message& configuration,
                 const std::function<Result<std::unique_ptr<Service>>()>& make);

}  // namespace pursuit
