// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/evaluation/evaluate.hpp"

#include <charconv>
#include <cstdio>
#include <memory>

#include "services/ctl/commands/offline_commands.hpp"
#include "services/ctl/commands/option_values.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/evaluation/score.hpp"
#include "services/ctl/evaluation/track_table.hpp"
#include "services/sensor/formats/formats.hpp"
#include "services/sensor/range_reader.hpp"
#include "services/tracker/model_file.hpp"

namespace pursuit::ctl {
namespace {

constexpr double longest_ms = 86'400'000;

struct EvaluateOptions {
    std::string poses;
    std::string truth;
    std::vector<std::string> models;
    std::string events;
    std::vector<std::string> symmetry;
    EvaluationSettings settings;
    bool json = false;
};

Result<std::map<std::string, ModelPoints>> read_models(const std::vector<std::string>& arguments) {
    std::map<std::string, ModelPoints> models;
    for (const auto& argument : arguments) {
        const auto equals = argument.find('=');
        const auto path = equals == std::string::npos ? argument : argument.substr(equals + 1);
        const auto model = tracker::read_model_file(path);
        if (!model) return tl::unexpected(model.error());
        auto& points =
            models[equals == std::string::npos ? model->shape.name : argument.substr(0, equals)];
        points.clear();
        for (const auto& point : model->shape.points_px) points.push_back(point.cast<double>());
    }
    return models;
}

Result<std::map<std::string, int>> read_symmetry(const std::vector<std::string>& arguments,
                                                 const std::map<std::string, ModelPoints>& models) {
    std::map<std::string, int> symmetry;
    for (const auto& argument : arguments) {
        const auto equals = argument.find('=');
        const auto count = argument.substr(std::min(equals, argument.size() - 1) + 1);
        int turns = 0;
        const auto* last = count.data() + count.size();
        const auto [end, error] = std::from_chars(count.data(), last, turns);
        if (equals == std::string::npos || error != std::errc() || end != last || turns < 1 ||
            turns > 360) {
            return fail("--symmetry: \"" + argument + "\" is not NAME=N with N from 1 to 360");
        }
        const auto name = argument.substr(0, equals);
        if (!models.contains(name)) {
            return fail("--symmetry: \"" + name + "\" is the name of none of the models given");
        }
        symmetry[name] = turns;
    }
    return symmetry;
}

Result<std::vector<Event>> read_events(const std::string& path) {
    auto recording = sensor::open_events(path);
    if (!recording) return tl::unexpected(recording.error());
    std::vector<Event> events;
    std::vector<Event> block(8192);
    for (;;) {
        const auto count = (*recording)->read(block);
        if (!count) return tl::unexpected(count.error());
        if (*count == 0) return events;
        events.insert(events.end(), block.begin(),
                      block.begin() + static_cast<std::ptrdiff_t>(*count));
    }
}

Result<std::vector<Score>> score(EvaluateOptions& options) {
    const auto range = sensor::range_of_seconds(options.settings.from_s, options.settings.to_s);
    if (!range) return fail("--from, --to: " + range.error().message);
    const auto models = read_models(options.models);
    if (!models) return tl::unexpected(models.error());
    const auto symmetry = read_symmetry(options.symmetry, *models);
    if (!symmetry) return tl::unexpected(symmetry.error());
    options.settings.symmetry = *symmetry;
    const auto poses = read_object_rows(options.poses);
    if (!poses) return tl::unexpected(poses.error());
    const auto truth = read_object_rows(options.truth);
    if (!truth) return tl::unexpected(truth.error());
    std::vector<Event> events;
    if (!options.events.empty()) {
        auto read = read_events(options.events);
        if (!read) return tl::unexpected(read.error());
        events = std::move(*read);
    }
    auto scores = evaluate(*poses, *truth, *models, options.events.empty() ? nullptr : &events,
                           options.settings);
    if (scores && scores->empty()) {
        return fail(options.truth + ": no object of it has one of the models given");
    }
    return scores;
}

int evaluate(EvaluateOptions& options) {
    const auto scores = score(options);
    if (!scores) return report(scores.error());
    const auto text = options.json ? to_json(*scores) : to_table(*scores);
    std::fputs(text.c_str(), stdout);
    return exit_success;
}

}  // namespace

Run define_evaluate(CLI::App& app) {
    auto options = std::make_shared<EvaluateOptions>();
    auto& settings = options->settings;
    app.add_option("--poses", options->poses, "Table of poses, CSV")->required();
    app.add_option("--truth", options->truth, "Table of truth, CSV")->required();
    app.add_option("--model", options->models, "[NAME=]FILE; once an object")->required();
    app.add_option("--events", options->events, "Recording of events: adds D1");
    app.add_option("--symmetry", options->symmetry,
                   "NAME=N: the shape has N turns that map it onto itself");
    app.add_option("--from", settings.from_s, "Scored from here, seconds")->capture_default_str();
    app.add_option("--to", settings.to_s, "Scored to here, seconds; 0: to the end")
        ->capture_default_str();
    app.add_option("--fresh", settings.fresh_ms,
                   "Up to this age, ms, a pose is compared with the truth at its own time")
        ->check(finite_range(0, longest_ms))
        ->capture_default_str();
    app.add_option("--speed-window", settings.speed_window_s,
                   "Half width of the slopes, seconds; 0: no speed error")
        ->check(finite_range(0, longest_ms / 1000))
        ->capture_default_str();
    app.add_flag("--json", options->json, "JSON instead of a table");
    return [options] { return evaluate(*options); };
}

}  // namespace pursuit::ctl
