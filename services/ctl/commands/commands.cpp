// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "services/ctl/commands/command.hpp"
#include "services/ctl/commands/dds_commands.hpp"
#include "services/ctl/commands/offline_commands.hpp"

namespace pursuit::ctl {
namespace {

constexpr Command all_commands[] = {
    {"model", "extract", "Make a model from what moved in a recording", define_model_extract},
    {"", "track", "Follow models through a recording, without DDS", define_track},
    {"", "evaluate", "Score poses against the truth", define_evaluate},
    {"", "simulate", "Make the events of a scene, and their truth", define_simulate},
    {"", "info", "Tell what is in a recording of events", define_info},
    {"", "convert", "Write a recording of events in another format", define_convert},
    {"", "grey", "Make a grey-level image from exposure measurements", define_grey},
    {"", "report", "Write a page about a recorded run", define_report},
    {"", "parameters", "List every parameter and preset by name", define_parameters},
    {"", "status", "Health, rates and losses of the services", define_status},
    {"", "poses", "Poses as they come", define_poses},
    {"model", "register", "Have a model tracked", define_model_register},
    {"model", "list", "Names of what is tracked", define_model_list},
    {"model", "show", "A registered model with its parameters", define_model_show},
    {"model", "remove", "Track it no more", define_model_remove},
    {"strategy", "get", "How events near several objects are assigned", define_strategy_get},
    {"strategy", "set", "Switch it", define_strategy_set},
    {"strategy", "list", "The names there are", define_strategy_list},
    {"pose", "set", "Let a track begin anew at a pose", define_pose_set},
    {"parameter", "set", "Set parameters of the tracker or of an object", define_parameter_set},
    {"sensor", "pause", "Stop the source's time", define_sensor_pause},
    {"sensor", "resume", "Let it go on", define_sensor_resume},
    {"sensor", "rate", "Play at another speed", define_sensor_rate},
    {"sensor", "filters", "Set what its events go through", define_sensor_filters},
    {"sensor", "filter-kinds", "List every filter and its parameters", define_sensor_filter_kinds},
    {"recorder", "pause", "Stop recording or replaying", define_recorder_pause},
    {"recorder", "resume", "Go on with it", define_recorder_resume},
    {"recorder", "new-file", "Close the file and go on in a new one", define_recorder_new_file},
    {"recorder", "rate", "Replay at another speed", define_recorder_rate},
};

constexpr std::pair<std::string_view, std::string_view> groups[] = {
    {"model", "Shapes: made from recordings, tracked or not"},
    {"strategy", "Who gets an event near several objects"},
    {"pose", "Where an object is thought to be"},
    {"parameter", "Constants of the tracker and of its objects"},
    {"sensor", "Calls on pursuit-sensor"},
    {"recorder", "Calls on pursuit-recorder"},
};

}  // namespace

std::span<const Command> commands() { return all_commands; }

std::string_view about(std::string_view group) {
    for (const auto& [name, what] : groups) {
        if (name == group) return what;
    }
    return "";
}

}  // namespace pursuit::ctl
