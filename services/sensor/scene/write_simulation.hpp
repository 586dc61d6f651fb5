// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/common/event.hpp"
#include "services/common/result.hpp"
#include "services/sensor/scene/scene.hpp"

namespace pursuit::sensor {

/// Takes consecutive events, in order; and exposure measurements, where the scene makes them.
using EventSink =
    std::function<Result<void>(std::span<const Event> events, std::span<const Event> exposures)>;

struct SimulationFiles {
    /// Truth every 1 ms: t_us,object_id,model,x_px,y_px,a00,a01,a10,a11,theta_rad,scale_x,scale_y,
    /// visible_fraction,fit_px.
    std::string truth_path;

    /// A folder, made where missing, for model_<name>.csv (x_px,y_px about the centre of gravity),
    /// model_<name>_edges.csv (from,to), model_true_<name>.csv where models carry click errors, and
    /// start.csv (object,x_px,y_px,theta_rad,scale,mode,error_x_px,error_y_px,error_theta_rad,
    /// error_scale,transform; mode is pose or search).
    std::optional<std::string> models_dir;

    /// Instead of the scene's own; an endless scene needs one.
    std::optional<double> duration_s;

    /// Files that no model may overwrite, besides the truth: inputs, and what else is written.
    std::vector<std::string> kept_paths;
};

struct SimulationSummary {
    std::uint64_t events = 0;
    std::int64_t duration_us = 0;
};

/// Simulates a scene from its start to its end and writes what came of it. A truth that is there
/// keeps what it holds until all that is to be written could be opened.
Result<SimulationSummary> write_simulation(const Scene& scene, std::uint64_t seed,
                                           const EventSink& events, const SimulationFiles& files);

/// The models of a scene and their start poses, as SimulationFiles.models_dir says.
Result<void> write_models(const Scene& scene, std::uint64_t seed, const std::string& models_dir);

}  // namespace pursuit::sensor
