// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/tracker/core/call_result.hpp"
#include "services/tracker/core/kinds.hpp"

namespace pursuit::tracker {

/// A parameter by name, as on the wire. Names have at most 47 characters.
struct NamedValue {
    std::string name;
    double value = 0;

    friend bool operator==(const NamedValue&, const NamedValue&) = default;
};

/// The constants of one object. Names, units, ranges and meanings: object_parameter_table().
struct ObjectParameters {
    double gate_px = 4;
    double let_go_sharpness = 0.31;
    double depth_order = 0;
    double uses_event_clock = 1;
    double remembers_pace = 1;
    double uses_leads = 1;
    double holds_leads = 1;
    double learns_trail = 1;
    double tells_contrast = 1;
    double tells_polarity = 1;
    double remembers_levels = 1;
    double hears_silence = 1;
    double learns_steadiness = 1;
    double measures_clutter = 1;
    double adapts_noise = 1;
    double watches_noise = 1;
    double learns_offsets = 1;
    double learns_bend = 1;
    double gradient_position_gain = 0.03;
    double gradient_angle_gain_rad_px2 = 5e-5;
    double gradient_scale_gain_1_px = 1e-4;
    double gradient_affine_gain_1_px2 = 4e-5;

    friend bool operator==(const ObjectParameters&, const ObjectParameters&) = default;
};

/// The constants of the tracker as a whole.
struct TrackerParameters {
    double coast_s = 0.8;
    double tells_occlusion = 1;
    double checks_pose = 1;

    friend bool operator==(const TrackerParameters&, const TrackerParameters&) = default;
};

/// The constants of the occlusion strategies.
struct StrategyParameters {
    double ambiguity_px = 3;
    double temporal_events = 50;
    double plane_window_s = 1;
    double plane_time_px_s = 300;
    double plane_in_sigma = 1;
    double plane_feed = 2;
    double plane_last_per_pixel = 0;
    double plane_filters_unambiguous = 0;
    double plane_filters_background = 0;
    double plane_reach = 3;
    double plane_refit_s = 0.001;
    double plane_events = 65'536;

    friend bool operator==(const StrategyParameters&, const StrategyParameters&) = default;
};

/// One line of a table: how a parameter is called, where it is, and what it may be.
template <class Parameters>
struct Parameter {
    std::string_view name;
    double Parameters::*member;
    double min;
    double max;
    std::string_view unit;
    std::string_view meaning;
};

/// Everything that can be set by name. Each table has at most 32 lines (the wire's bound), and the
/// names of object and tracker parameters differ.
std::span<const Parameter<ObjectParameters>> object_parameter_table();
std::span<const Parameter<TrackerParameters>> tracker_parameter_table();
std::span<const Parameter<StrategyParameters>> strategy_parameter_table();

/// Sets values by name. An unknown name is not_found, a value that is not a number within its range
/// is invalid_argument; the message names both. On an error nothing is set.
CallResult<void> set(ObjectParameters& parameters, std::span<const NamedValue> values);
CallResult<void> set(TrackerParameters& parameters, std::span<const NamedValue> values);
CallResult<void> set(StrategyParameters& parameters, std::span<const NamedValue> values);

/// All values in force, in the order of the table.
std::vector<NamedValue> values(const ObjectParameters& parameters);
std::vector<NamedValue> values(const TrackerParameters& parameters);
std::vector<NamedValue> values(const StrategyParameters& parameters);

/// A whole set of constants under one word.
struct Preset {
    std::string_view name;
    std::string_view meaning;
    EstimatorKind estimator;  ///< For objects registered without a choice of their own.
    StrategyKind strategy;
    ObjectParameters object;
    TrackerParameters tracker;
    StrategyParameters strategy_parameters;
};

/// "default" and "paper".
std::span<const Preset> presets();

/// The preset of that name; not_found names those there are.
CallResult<const Preset*> find_preset(std::string_view name);

}  // namespace pursuit::tracker
