// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>

#include "services/ctl/commands/command.hpp"
#include "services/ctl/commands/report.hpp"

namespace {

/// The chosen command to its end; gives the exit code.
int run(int argc, char** argv) {
    CLI::App app("Commands and inspects Pursuit, and does its work on files");
    app.require_subcommand(1);
    app.set_version_flag("--version", PURSUIT_VERSION);

    pursuit::ctl::Run chosen;
    std::map<std::string_view, CLI::App*> groups{{"", &app}};
    for (const auto& command : pursuit::ctl::commands()) {
        auto*& group = groups[command.group];
        if (group == nullptr) {
            group = app.add_subcommand(std::string(command.group),
                                       std::string(pursuit::ctl::about(command.group)));
            group->require_subcommand(1);
        }
        auto* own = group->add_subcommand(std::string(command.name), std::string(command.what));
        own->callback([&chosen, run = command.define(*own)] { chosen = run; });
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::RequiredError& error) {
        // What is required is missing because another word stands in its place.
        const auto unknown = app.remaining(true);
        if (unknown.empty()) return app.exit(error);
        return app.exit(CLI::ExtrasError("\"" + unknown.front() + "\" is no command or option here",
                                         CLI::ExitCodes::ExtrasError));
    } catch (const CLI::ParseError& error) {
        return app.exit(error);
    }
    return chosen();
}

}  // namespace

int main(int argc, char** argv) {
    const int code = run(argc, argv);
    // What a command printed may be its result, and the last of it is written only here. A write
    // that failed before leaves its mark on the stream.
    errno = 0;
    const bool printed = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
    if (printed) return code;
    const std::string cause = errno == 0 ? "" : std::string(": ") + std::strerror(errno);
    const int failed = pursuit::ctl::report({"standard output: cannot write" + cause});
    return code == pursuit::exit_success ? failed : code;
}
