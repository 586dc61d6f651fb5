// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/ctl/commands/command.hpp"

// The sub-commands that talk to services. Each is defined in the file of its group.
namespace pursuit::ctl {

Run define_model_register(CLI::App& app);
Run define_model_list(CLI::App& app);
Run define_model_show(CLI::App& app);
Run define_model_remove(CLI::App& app);
Run define_strategy_get(CLI::App& app);
Run define_strategy_set(CLI::App& app);
Run define_strategy_list(CLI::App& app);
Run define_pose_set(CLI::App& app);
Run define_parameter_set(CLI::App& app);
Run define_poses(CLI::App& app);
Run define_status(CLI::App& app);
Run define_sensor_pause(CLI::App& app);
Run define_sensor_resume(CLI::App& app);
Run define_sensor_rate(CLI::App& app);
Run define_sensor_filters(CLI::App& app);
Run define_sensor_filter_kinds(CLI::App& app);
Run define_recorder_pause(CLI::App& app);
Run define_recorder_resume(CLI::App& app);
Run define_recorder_new_file(CLI::App& app);
Run define_recorder_rate(CLI::App& app);

}  // namespace pursuit::ctl
