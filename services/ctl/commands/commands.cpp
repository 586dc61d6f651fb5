// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/commands/command.hpp"
#include "services/ctl/commands/offline_commands.hpp"

namespace pursuit::ctl {
namespace {

constexpr Command table[] = {
    {"model", "extract", "Make a model from what moved in a recording", define_model_extract},
    {"", "track", "Follow models through a recording, without DDS", define_track},
    {"", "evaluate", "Score poses against the truth", define_evaluate},
    {"", "simulate", "Make the events of a scene, and their truth", define_simulate},
    {"", "info", "Tell what is in a recording of events", define_info},
    {"", "convert", "Write a recording of events in another format", define_convert},
    {"", "report", "Write a page about a recorded run", define_report},
    {"", "parameters", "List every parameter and preset by name", define_parameters},
};

}  // namespace

std::span<const Command> commands() { return table; }

}  // namespace pursuit::ctl
