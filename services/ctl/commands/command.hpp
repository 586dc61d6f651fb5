// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <span>
#include <string_view>

namespace pursuit::ctl {

/// What a sub-command does once its options are parsed; gives the exit code.
using Run = std::function<int()>;

/// A sub-command of pursuitctl: one file in this folder, and one line in the table of commands.cpp.
struct Command {
    std::string_view group;  ///< The word before it, as in "model extract"; empty for none.
    std::string_view name;
    std::string_view what;  ///< One line for people.

    /// Adds its options to `app` and returns what is run when it was chosen.
    Run (*define)(CLI::App& app);
};

std::span<const Command> commands();

/// What the commands of a group are for, one line.
std::string_view about(std::string_view group);

}  // namespace pursuit::ctl
