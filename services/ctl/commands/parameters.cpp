// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/parameters.hpp"

#include <cstdio>

#include "services/common/service_main.hpp"
#include "services/ctl/commands/offline_commands.hpp"

namespace pursuit::ctl {
namespace {

template <class Parameters>
void print(const char* title, std::span<const tracker::Parameter<Parameters>> table) {
    const Parameters defaults;
    std::printf("%s\n", title);
    for (const auto& line : table) {
        std::printf("  %-34.*s %10g  %g … %g %.*s\n      %.*s\n",
                    static_cast<int>(line.name.size()), line.name.data(), defaults.*line.member,
                    line.min, line.max, static_cast<int>(line.unit.size()), line.unit.data(),
                    static_cast<int>(line.meaning.size()), line.meaning.data());
    }
}

int print_parameters() {
    std::printf("name, default, range and unit, meaning\n\n");
    print("of an object (model register --set, parameter set):", tracker::object_parameter_table());
    print("\nof the tracker (parameter set):", tracker::tracker_parameter_table());
    print("\nof the occlusion strategies (strategy set --set):",
          tracker::strategy_parameter_table());
    std::printf("\npresets (preset: in the configuration, track --preset):\n");
    for (const auto& preset : tracker::presets()) {
        std::printf("  %-34.*s %.*s\n", static_cast<int>(preset.name.size()), preset.name.data(),
                    static_cast<int>(preset.meaning.size()), preset.meaning.data());
    }
    return exit_success;
}

}  // namespace

Run define_parameters(CLI::App&) { return print_parameters; }

}  // namespace pursuit::ctl
