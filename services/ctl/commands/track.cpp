// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "services/common/settings.hpp"
#include "services/common/text_format.hpp"
#include "services/ctl/commands/offline_commands.hpp"
#include "services/ctl/commands/option_values.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/offline_track.hpp"
#include "services/tracker/start_settings.hpp"

namespace pursuit::ctl {
namespace {

struct TrackOptions {
    OfflineTrack task;
    FieldPlaces places;  ///< Of the task's configuration.
    std::vector<std::string> settings;
    std::string strategy;
    std::string estimator;
    std::string preset;
    std::string transform;
    std::string geometry;
    double from_s = 0;
    double to_s = 0;
};

Result<void> complete(TrackOptions& options) {
    auto& task = options.task;
    if (!task.config_path.empty()) {
        auto ok = read_text_file(task.config_path, task.config, &options.places);
        if (!ok) return ok;
    }
    if (auto ok = apply_settings(options.settings, task.config, &options.places); !ok) return ok;
    if (!options.preset.empty()) {
        task.config.set_preset(options.preset);
        options.places.note("preset", "--preset " + options.preset);
    }
    if (!options.strategy.empty()) {
        task.config.set_strategy(options.strategy);
        options.places.note("strategy", "--strategy " + options.strategy);
    }
    int index = task.config.model_size();
    for (const auto& model : task.models) {
        options.places.note("model[" + std::to_string(index++) + "]", "--model " + model);
    }
    if (!options.transform.empty()) {
        task.transform = tracker::parse_transform(options.transform);
        if (!task.transform) {
            return fail("--transform: \"" + options.transform + "\" is not " +
                        tracker::transform_names());
        }
    }
    if (!options.estimator.empty()) {
        task.estimator = tracker::parse_estimator(options.estimator);
        if (!task.estimator) {
            return fail("--estimator: \"" + options.estimator + "\" is not " +
                        tracker::estimator_names());
        }
    }
    // Before any event is read: the parts of a configuration that only a tracker can judge.
    if (const auto made = tracker::configured_tracker(task.config, 1); !made) {
        return tl::unexpected(options.places.located(made.error(), task.config_path));
    }
    return {};
}

/// Events that were dropped, and how often objects were lost, where there are any.
void tell_losses(const tracker::TrackerCounters& counters) {
    const auto tell = [](std::uint64_t count, const std::string& what) {
        if (count > 0) {
            std::fprintf(stderr, "%llu %s\n", static_cast<unsigned long long>(count), what.c_str());
        }
    };
    tell(counters.dropped_outside_geometry, "events dropped: outside the image");
    tell(counters.dropped_time_went_back, "events dropped: earlier than one before");
    tell(counters.dropped_time_out_of_range, "events dropped: no time that a tracker takes");
    tell(counters.poses_thinned, "poses left out: more than max_poses_per_s");
    for (std::size_t i = 1; i < counters.lost_by.size(); ++i) {
        tell(counters.lost_by[i], "times an object was lost: " +
                                      std::string(to_string(static_cast<tracker::LossCause>(i))));
    }
}

int track(TrackOptions& options) {
    if (auto ok = complete(options); !ok) return report(ok.error(), exit_configuration);
    const auto range = sensor::range_of_seconds(options.from_s, options.to_s);
    if (!range) return report(range.error());
    options.task.range = *range;
    const auto geometry = geometry_of(options.geometry);
    if (!geometry) return report(geometry.error());
    options.task.geometry = *geometry;
    const auto done = track_offline(options.task);
    if (!done) return report(options.places.located(done.error(), ""));
    const auto& counters = done->counters;
    std::fprintf(stderr, "%llu events in %.2f s (%.2f M/s), %llu used; %llu poses\n",
                 static_cast<unsigned long long>(counters.events_in), done->wall_s,
                 static_cast<double>(counters.events_in) / 1e6 / std::max(done->wall_s, 1e-9),
                 static_cast<unsigned long long>(counters.events_used),
                 static_cast<unsigned long long>(counters.poses_emitted));
    tell_losses(counters);
    const bool is_whole = range->start_us == 0 && range->end_us == 0;
    if (counters.events_in == 0 && !is_whole) {
        return report({options.task.events + ": no event lies in the range of --from and --to"});
    }
    return exit_success;
}

}  // namespace

Run define_track(CLI::App& app) {
    auto options = std::make_shared<TrackOptions>();
    app.add_option("--events", options->task.events, "Recording of events")->required();
    app.add_option("--model", options->task.models, "PATH[@x,y,theta[,scale]]; once an object");
    app.add_option("--poses", options->task.poses, "Table of poses to write, CSV")->required();
    app.add_option("--config", options->task.config_path, "Configuration of the tracker");
    app.add_option("--set", options->settings, "field=value over the configuration");
    app.add_option("--preset", options->preset, "The constants to begin with");
    app.add_option("--strategy", options->strategy, tracker::strategy_names());
    app.add_option("--estimator", options->estimator, tracker::estimator_names());
    app.add_option("--transform", options->transform, tracker::transform_names());
    app.add_option("--from", options->from_s, "Begin here, seconds of the recording's time");
    app.add_option("--to", options->to_s, "End before here; 0: to the end");
    app.add_option("--geometry", options->geometry, geometry_help);
    return [options] { return track(*options); };
}

}  // namespace pursuit::ctl
