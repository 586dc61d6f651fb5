// SPDX-License-Identifier: Apache-2.0
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/common/output_file.hpp"
#include "services/ctl/commands/offline_commands.hpp"
#include "services/ctl/commands/option_values.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/sensor/formats/formats.hpp"
#include "services/sensor/scene/scene.hpp"
#include "services/sensor/scene/write_simulation.hpp"

namespace pursuit::ctl {
namespace {

struct SimulateOptions {
    std::string scene;
    std::vector<std::string> settings;
    std::string events;
    std::string models;
    std::uint64_t seed = 1;
    double duration_s = 0;
    sensor::SimulationFiles files;
};

Result<sensor::SimulationSummary> write(const SimulateOptions& options,
                                        const sensor::Scene& scene) {
    const auto& array = scene.description().sensor();
    const Geometry geometry{static_cast<std::uint16_t>(array.width()),
                            static_cast<std::uint16_t>(array.height())};
    if (options.events.empty()) {
        const auto nothing = [](std::span<const Event>, std::span<const Event>) {
            return Result<void>();
        };
        return sensor::write_simulation(scene, options.seed, nothing, options.files);
    }
    auto writer = sensor::create_events(options.events, geometry, array.exposure_us() > 0);
    if (!writer) return tl::unexpected(writer.error());
    const auto summary = sensor::write_simulation(
        scene, options.seed,
        [&](std::span<const Event> events, std::span<const Event> exposures) {
            return (*writer)->holds_exposures() ? (*writer)->write(events, exposures)
                                                : (*writer)->write(events);
        },
        options.files);
    if (!summary) return summary;
    if (auto ok = (*writer)->close(); !ok) return tl::unexpected(ok.error());
    return summary;
}

Result<void> check_outputs(const SimulateOptions& options) {
    for (const auto& output : {options.events, options.files.truth_path}) {
        if (auto ok = check_is_not_input(output, options.scene); !ok) return ok;
    }
    if (options.events.empty()) return {};
    return check_are_two_outputs(options.events, options.files.truth_path);
}

int simulate(SimulateOptions& options) {
    const auto scene = sensor::load_scene(options.scene, options.settings);
    if (!scene) return report(scene.error(), exit_configuration);
    if (auto ok = check_outputs(options); !ok) return report(ok.error());
    options.files.kept_paths = {options.scene};
    if (!options.events.empty()) options.files.kept_paths.push_back(options.events);
    if (!options.models.empty()) options.files.models_dir = options.models;
    if (options.duration_s != 0) options.files.duration_s = options.duration_s;
    const auto summary = write(options, *scene);
    if (!summary) return report(summary.error());
    std::printf("%" PRIu64 " events in %.3f s\n", summary->events,
                static_cast<double>(summary->duration_us) * 1e-6);
    return exit_success;
}

std::string scene_help() {
    std::string names;
    for (const auto& name : sensor::list_builtin_scenes()) {
        names += (names.empty() ? "" : ", ") + name;
    }
    return "A *.scene.textproto, or one of " + names;
}

}  // namespace

Run define_simulate(CLI::App& app) {
    auto options = std::make_shared<SimulateOptions>();
    app.add_option("SCENE", options->scene, scene_help())->required();
    app.add_option("--set", options->settings,
                   "field=value over the scene, as sensor.threshold=0.3 or "
                   "layer[0].trajectory.vx_px_s=20");
    app.add_option("--seed", options->seed, "Of the scene's choices and noise")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option("--events", options->events,
                   "Recording to write; its extension is its format. Without: the truth alone");
    app.add_option("--truth", options->files.truth_path, "Table of truth to write, CSV")
        ->required();
    app.add_option("--models", options->models, "Folder for the models and their start poses");
    app.add_option("--duration", options->duration_s, "Seconds; 0: as the scene says")
        ->check(finite_range(0, 86'400))
        ->capture_default_str();
    return [options] { return simulate(*options); };
}

}  // namespace pursuit::ctl
