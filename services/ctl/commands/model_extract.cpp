// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include "services/common/output_file.hpp"
#include "services/ctl/commands/offline_commands.hpp"
#include "services/ctl/commands/option_values.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/extraction/extract_model.hpp"
#include "services/sensor/formats/formats.hpp"
#include "services/sensor/range_reader.hpp"

namespace pursuit::ctl {
namespace {

struct ExtractOptions {
    Extraction task;
    std::string events;
    std::string output;
    std::string geometry;
    double at_s = 0;
    double window_ms = 20;
    std::vector<int> roi;
};

/// "car" of "models/car.model.textproto".
std::string stem_of(const std::string& path) {
    const auto file = std::filesystem::path(path).filename().string();
    return file.substr(0, file.find('.'));
}

int extract(ExtractOptions& options) {
    auto& task = options.task;
    const auto range = sensor::range_of_seconds(options.at_s, 0);
    if (!range) return report(range.error());
    task.start_us = range->start_us;
    if (!(options.window_ms > 0 && options.window_ms <= 60'000)) {
        return report({"--window: must be more than 0 and at most 60000 ms"});
    }
    task.window_us = std::llround(options.window_ms * 1e3);
    if (!options.roi.empty()) {
        task.x_px = options.roi[0];
        task.y_px = options.roi[1];
        task.width_px = options.roi[2];
        task.height_px = options.roi[3];
    }
    if (task.name.empty()) task.name = stem_of(options.output);

    const auto geometry = geometry_of(options.geometry);
    if (!geometry) return report(geometry.error());
    if (auto ok = check_is_not_input(options.output, options.events); !ok) {
        return report(ok.error());
    }
    sensor::ReadOptions read_options;
    read_options.geometry = *geometry;
    auto recording = sensor::open_events(options.events, read_options);
    if (!recording) return report(recording.error());
    const auto extracted = extract_model(**recording, task);
    if (!extracted) return report(extracted.error());
    if (auto ok = tracker::write_model_file(options.output, extracted->model); !ok) {
        return report(ok.error());
    }
    const auto& model = extracted->model;
    std::fprintf(summary_of(options.output),
                 "%s: %zu points, %zu links, %s; centre of gravity at (%.2f, %.2f) px\n",
                 options.output.c_str(), model.shape.points_px.size(), model.shape.edges.size(),
                 model.comment.c_str(), model.origin_px->x(), model.origin_px->y());
    return exit_success;
}

}  // namespace

Run define_model_extract(CLI::App& app) {
    auto options = std::make_shared<ExtractOptions>();
    app.add_option("--events", options->events, "Recording of events")->required();
    app.add_option("--at", options->at_s, "Begin of the window, seconds of the recording's time")
        ->required();
    app.add_option("--window", options->window_ms, "Length of the window, ms")
        ->capture_default_str();
    app.add_option("--roi", options->roi, "Rectangle X,Y,W,H, px; the whole image without")
        ->delimiter(',')
        ->expected(4);
    app.add_option("--points", options->task.points, "At most, 3 to 4096")->capture_default_str();
    app.add_flag("--links,!--no-links", options->task.links,
                 "Tell which points a contour joins; without, the tracker infers it");
    app.add_option("--name", options->task.name, "Of the model; else that of the file");
    app.add_option("--output", options->output, "Model to write, *.model.textproto")->required();
    app.add_option("--geometry", options->geometry, geometry_help);
    return [options] { return extract(*options); };
}

}  // namespace pursuit::ctl
