// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/ctl/commands/command.hpp"

// The sub-commands that need no service and no DDS. Each is defined in the file of its name.
namespace pursuit::ctl {

Run define_convert(CLI::App& app);
Run define_evaluate(CLI::App& app);
Run define_grey(CLI::App& app);
Run define_info(CLI::App& app);
Run define_model_extract(CLI::App& app);
Run define_simulate(CLI::App& app);
Run define_parameters(CLI::App& app);
Run define_report(CLI::App& app);
Run define_track(CLI::App& app);

}  // namespace pursuit::ctl
