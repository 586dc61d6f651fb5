// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "services/ctl/commands/command.hpp"

int main(int argc, char** argv) {
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
    CLI11_PARSE(app, argc, argv);
    return chosen();
}
