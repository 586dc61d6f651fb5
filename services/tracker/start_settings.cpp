// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/start_settings.hpp"

#include <algorithm>
#include <span>
#include <string>

#include "services/tracker/model_file.hpp"

namespace pursuit::tracker {
namespace {

// A stream of a larger image waits until memory for it is there, some tens of ms.
constexpr Geometry usual_geometry{1280, 720};

bool is_of_strategies(const std::string& name) {
    const auto table = strategy_parameter_table();
    return std::any_of(table.begin(), table.end(),
                       [&](const auto& parameter) { return parameter.name == name; });
}

std::string model_field(int index) { return "model[" + std::to_string(index) + "]"; }

}  // namespace

Result<Registration> configured_model(const std::string& argument, EstimatorKind estimator) {
    auto parsed = parse_model_argument(argument);
    if (!parsed) return tl::unexpected(parsed.error());
    auto file = read_model_file(parsed->path);
    if (!file) return tl::unexpected(file.error());
    Registration registration;
    registration.shape = std::move(file->shape);
    registration.estimator = estimator;
    if (parsed->start) {
        registration.start.pose = *parsed->start;
        if (scale_x(parsed->start->a) != 1) registration.transform = TransformKind::similarity;
    } else if (file->origin_px) {
        registration.start.pose.t_px = *file->origin_px;
    } else {
        registration.start.search = true;
    }
    return registration;
}

Result<Tracker> configured_tracker(const disk::TrackerConfig& config, std::uint32_t next_object_id,
                                   bool only_checks) {
    TrackerOptions options;
    options.pose_rate_hz = config.pose_rate_hz();
    options.max_poses_per_s = config.max_poses_per_s();
    options.max_objects = config.max_objects();
    options.preset = config.preset();
    options.emit_updates = config.pose_tracks();
    options.next_object_id = next_object_id;
    options.only_checks = only_checks;
    options.reserved = usual_geometry;
    if (const auto preset = find_preset(config.preset()); !preset) {
        return fail_field("preset", ": " + preset.error().message);
    }
    auto made = Tracker::create(options);
    if (!made) return fail(made.error().message);
    std::vector<NamedValue> of_strategy;
    for (int i = 0; i < config.parameter_size(); ++i) {
        const NamedValue value{config.parameter(i).name(), config.parameter(i).value()};
        for (int before = 0; before < i; ++before) {
            if (config.parameter(before).name() != value.name) continue;
            return fail_field("parameter[" + std::to_string(i) + "]",
                              ": parameter '" + value.name + "': given twice");
        }
        const std::span one(&value, 1);
        CallResult<void> good;
        if (is_of_strategies(value.name)) {
            of_strategy.push_back(value);
            StrategyParameters tried = made->settings().strategy_parameters;
            good = set(tried, one);
        } else {
            good = made->set_parameters("", one);
        }
        if (!good) {
            return fail_field("parameter[" + std::to_string(i) + "]", ": " + good.error().message);
        }
    }
    // Where the configuration names no strategy, the preset's holds.
    const auto strategy =
        config.has_strategy() ? parse_strategy(config.strategy()) : made->settings().strategy;
    if (!strategy) {
        return fail_field("strategy",
                          ": unknown \"" + config.strategy() + "\", must be " + strategy_names());
    }
    if (auto ok = made->set_strategy(*strategy, of_strategy); !ok) {
        return fail_field("strategy", ": " + ok.error().message);
    }
    return std::move(*made);
}

Result<std::vector<Registration>> configured_models(const disk::TrackerConfig& config) {
    const auto preset = find_preset(config.preset());
    if (!preset) return fail_field("preset", ": " + preset.error().message);
    std::vector<Registration> registrations;
    for (int i = 0; i < config.model_size(); ++i) {
        auto registration = configured_model(config.model(i), (*preset)->estimator);
        if (!registration) return fail_field(model_field(i), ": " + registration.error().message);
        const auto same = std::find_if(
            registrations.begin(), registrations.end(),
            [&](const auto& other) { return other.shape.name == registration->shape.name; });
        if (same != registrations.end()) {
            const auto first = static_cast<int>(same - registrations.begin());
            return fail_field(model_field(i),
                              ": two models are named " + same->shape.name + ", " +
                                  config.model(first) + " and " + config.model(i) +
                                  ": give one another name, by its field name, or a table by the "
                                  "name of its file");
        }
        registrations.push_back(std::move(*registration));
    }
    return registrations;
}

}  // namespace pursuit::tracker
