// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace pursuit::tracker {
namespace {

/// A switch; see KalmanParts.
constexpr Parameter<ObjectParameters> part_of_kalman(std::string_view name,
                                                     double ObjectParameters::*member,
                                                     std::string_view meaning) {
    return {name, member, 0, 1, "1", meaning};
}

constexpr std::array object_table{
    Parameter<ObjectParameters>{
        "gate_px", &ObjectParameters::gate_px, 0.5, 50, "px",
        "events farther from the model than this are not the object's; of the "
        "estimator kalman 6.5 px at most"},
    Parameter<ObjectParameters>{
        "let_go_sharpness", &ObjectParameters::let_go_sharpness, 0, 1, "1",
        "the object is let go where fewer of its events than this share lie "
        "within a quarter of the gate; 0.25 is chance, 0 never lets go"},
    Parameter<ObjectParameters>{"depth_order", &ObjectParameters::depth_order, 0, 1000, "1",
                                "an object of a lower number hides those of higher ones; 0: told "
                                "from the events that are missing"},
    part_of_kalman("uses_event_clock", &ObjectParameters::uses_event_clock,
                   "1: the rate of its events tells kalman how fast an object can turn away; 0: "
                   "its velocity alone"),
    part_of_kalman("remembers_pace", &ObjectParameters::remembers_pace,
                   "1: kalman is as ready for a turn as the speed of the last 0.15 s wants; 0: as "
                   "that of the moment does"),
    part_of_kalman("uses_leads", &ObjectParameters::uses_leads,
                   "1: for kalman events come ahead of an edge that moves; 0: on it (then trail, "
                   "contrast, polarity and levels are off, too)"),
    part_of_kalman(
        "holds_leads", &ObjectParameters::holds_leads,
        "1: kalman holds leads to what the physics of a pixel tells; 0: events alone tell them"),
    part_of_kalman(
        "learns_trail", &ObjectParameters::learns_trail,
        "1: kalman learns what the way since a pixel's last event does to the next; 0: nothing"),
    part_of_kalman("tells_contrast", &ObjectParameters::tells_contrast,
                   "1: kalman tells how strong each edge is, and how early its events come for it; "
                   "0: all edges are alike"),
    part_of_kalman("tells_polarity", &ObjectParameters::tells_polarity,
                   "1: polarity tells kalman which way an edge goes; 0: it goes as the pose did"),
    part_of_kalman(
        "remembers_levels", &ObjectParameters::remembers_levels,
        "1: kalman remembers where the edge was when a pixel crossed its levels; 0: it does not"),
    part_of_kalman(
        "hears_silence", &ObjectParameters::hears_silence,
        "1: parts of a contour that fall silent tell kalman of a turn; 0: the events alone do"),
    part_of_kalman(
        "learns_steadiness", &ObjectParameters::learns_steadiness,
        "1: of what goes steadily kalman expects smaller turns; 0: the usual ones of everything"),
    part_of_kalman(
        "measures_clutter", &ObjectParameters::measures_clutter,
        "1: kalman measures how many of the events are not the object's; 0: a fiftieth a px"),
    part_of_kalman("adapts_noise", &ObjectParameters::adapts_noise,
                   "1: kalman adapts its measurement noise to what comes; 0: it stays the usual"),
    part_of_kalman(
        "watches_noise", &ObjectParameters::watches_noise,
        "1: among strong noise kalman looks out for where the object shows; 0: it does not"),
    part_of_kalman("learns_offsets", &ObjectParameters::learns_offsets,
                   "1: kalman learns how far beside each piece of the contour its events come; 0: "
                   "the model is right"),
    part_of_kalman(
        "learns_bend", &ObjectParameters::learns_bend,
        "1: beside the full affine kalman learns the bend of a view in perspective; 0: it is flat"),
    Parameter<ObjectParameters>{"gradient_position_gain", &ObjectParameters::gradient_position_gain,
                                0, 0.5, "1", "eta1 of the paper: step of the position"},
    Parameter<ObjectParameters>{"gradient_angle_gain_rad_px2",
                                &ObjectParameters::gradient_angle_gain_rad_px2, 0, 0.1, "rad/px²",
                                "eta2 of the paper: step of the angle"},
    Parameter<ObjectParameters>{"gradient_scale_gain_1_px",
                                &ObjectParameters::gradient_scale_gain_1_px, 0, 0.1, "1/px",
                                "eta3 of the paper: step of the scales"},
    Parameter<ObjectParameters>{"gradient_affine_gain_1_px2",
                                &ObjectParameters::gradient_affine_gain_1_px2, 0, 0.1, "1/px²",
                                "step of A for the full affine transform"},
};

constexpr std::array tracker_table{
    Parameter<TrackerParameters>{"coast_s", &TrackerParameters::coast_s, 0, 60, "s",
                                 "how long an occluded object may coast before it is lost"},
    Parameter<TrackerParameters>{"tells_occlusion", &TrackerParameters::tells_occlusion, 0, 1, "1",
                                 "1: which object hides which is told, and hidden parts take no "
                                 "events; 0: the occlusion strategy alone decides"},
    Parameter<TrackerParameters>{"checks_pose", &TrackerParameters::checks_pose, 0, 1, "1",
                                 "1: searches confirm where an object is thought to be, at its "
                                 "start and after silences, or move it; 0: nothing does"},
};

constexpr std::array strategy_table{
    Parameter<StrategyParameters>{
        "ambiguity_px", &StrategyParameters::ambiguity_px, 0, 50, "px",
        "an event this near to two objects or more is given by the strategy"},
    Parameter<StrategyParameters>{"temporal_events", &StrategyParameters::temporal_events, 2, 10000,
                                  "events", "N of (3.12): events that an object's rate is over"},
    Parameter<StrategyParameters>{"plane_window_s", &StrategyParameters::plane_window_s, 0.001, 10,
                                  "s", "of (3.14): the time that an object's plane is laid over"},
    Parameter<StrategyParameters>{"plane_time_px_s", &StrategyParameters::plane_time_px_s, 1, 1e5,
                                  "px/s", "c of (3.14): how far a second is from another"},
    Parameter<StrategyParameters>{
        "plane_in_sigma", &StrategyParameters::plane_in_sigma, 0, 1, "0 or 1",
        "1: an event's distance to a plane is in units of the plane's own spread; 0: in px"},
    Parameter<StrategyParameters>{
        "plane_feed", &StrategyParameters::plane_feed, 0, 2, "0, 1, 2",
        "a plane is laid over the events 0: that its object took, 1: near it, 2: near it alone"},
    Parameter<StrategyParameters>{
        "plane_last_per_pixel", &StrategyParameters::plane_last_per_pixel, 0, 1, "0 or 1",
        "1: of a pixel's events only the last counts for a plane; 0: every one"},
    Parameter<StrategyParameters>{
        "plane_filters_unambiguous", &StrategyParameters::plane_filters_unambiguous, 0, 1, "0 or 1",
        "1: events near one object alone are left out beyond plane_reach of its plane"},
    Parameter<StrategyParameters>{
        "plane_filters_background", &StrategyParameters::plane_filters_background, 0, 1, "0 or 1",
        "1: ambiguous events are left out beyond plane_reach of the nearest plane"},
    Parameter<StrategyParameters>{"plane_reach", &StrategyParameters::plane_reach, 0, 1000,
                                  "sigma or px",
                                  "how far from a plane an event may be filtered in"},
    Parameter<StrategyParameters>{"plane_refit_s", &StrategyParameters::plane_refit_s, 0, 1, "s",
                                  "how old a plane may be before it is laid anew"},
    Parameter<StrategyParameters>{
        "plane_events", &StrategyParameters::plane_events, 20, 65'536, "events",
        "the most events a plane is laid over; with more, its time is shorter than plane_window_s"},
};

std::string shown(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

template <class Parameters>
CallResult<void> set_by_name(std::span<const Parameter<Parameters>> table, Parameters& parameters,
                             std::span<const NamedValue> values) {
    Parameters changed = parameters;
    for (const NamedValue& wanted : values) {
        const auto line = std::find_if(table.begin(), table.end(), [&](const auto& candidate) {
            return candidate.name == wanted.name;
        });
        if (line == table.end()) {
            return refuse(CallStatus::not_found,
                          "parameter '" + wanted.name.substr(0, 64) + "': no such parameter here");
        }
        if (!(wanted.value >= line->min && wanted.value <= line->max)) {
            return refuse(CallStatus::invalid_argument,
                          "parameter '" + wanted.name + "': " + shown(wanted.value) +
                              " is not within " + shown(line->min) + " to " + shown(line->max) +
                              " " + std::string(line->unit));
        }
        const auto is_same = [&](const NamedValue& other) { return other.name == wanted.name; };
        if (std::count_if(values.begin(), values.end(), is_same) > 1) {
            return refuse(CallStatus::invalid_argument,
                          "parameter '" + wanted.name + "': given twice");
        }
        changed.*(line->member) = wanted.value;
    }
    parameters = changed;
    return {};
}

template <class Parameters>
std::vector<NamedValue> all_values(std::span<const Parameter<Parameters>> table,
                                   const Parameters& parameters) {
    std::vector<NamedValue> listed;
    listed.reserve(table.size());
    for (const auto& line : table) {
        listed.push_back({std::string(line.name), parameters.*(line.member)});
    }
    return listed;
}

Preset paper() {
    Preset preset{"paper",
                  "the constants and readings of Ni et al. 2015 for traffic",
                  EstimatorKind::gradient,
                  StrategyKind::closest,
                  {},
                  {},
                  {}};
    preset.object.gate_px = 3;
    preset.tracker.tells_occlusion = 0;
    preset.tracker.checks_pose = 0;
    preset.object.let_go_sharpness = 0;  // The paper's tracks have no end.
    preset.object.gradient_position_gain = 0.1;
    preset.object.gradient_angle_gain_rad_px2 = 2e-5;
    preset.object.gradient_scale_gain_1_px = 1e-5;
    preset.strategy_parameters.plane_window_s = 3;
    preset.strategy_parameters.plane_in_sigma = 0;
    preset.strategy_parameters.plane_feed = 0;
    preset.strategy_parameters.plane_last_per_pixel = 1;
    return preset;
}

}  // namespace

std::span<const Parameter<ObjectParameters>> object_parameter_table() { return object_table; }
std::span<const Parameter<TrackerParameters>> tracker_parameter_table() { return tracker_table; }
std::span<const Parameter<StrategyParameters>> strategy_parameter_table() { return strategy_table; }

CallResult<void> set(ObjectParameters& parameters, std::span<const NamedValue> values) {
    return set_by_name(object_parameter_table(), parameters, values);
}
CallResult<void> set(TrackerParameters& parameters, std::span<const NamedValue> values) {
    return set_by_name(tracker_parameter_table(), parameters, values);
}
CallResult<void> set(StrategyParameters& parameters, std::span<const NamedValue> values) {
    return set_by_name(strategy_parameter_table(), parameters, values);
}

std::vector<NamedValue> values(const ObjectParameters& parameters) {
    return all_values(object_parameter_table(), parameters);
}
std::vector<NamedValue> values(const TrackerParameters& parameters) {
    return all_values(tracker_parameter_table(), parameters);
}
std::vector<NamedValue> values(const StrategyParameters& parameters) {
    return all_values(strategy_parameter_table(), parameters);
}

std::span<const Preset> presets() {
    static const std::array all{Preset{"default",
                                       "one set of constants for all scenes",
                                       EstimatorKind::kalman,
                                       StrategyKind::closest,
                                       {},
                                       {},
                                       {}},
                                paper()};
    return all;
}

CallResult<const Preset*> find_preset(std::string_view name) {
    std::string names;
    for (const Preset& preset : presets()) {
        if (preset.name == name) return &preset;
        names += (names.empty() ? "" : ", ") + std::string(preset.name);
    }
    return refuse(CallStatus::not_found, "preset '" + std::string(name.substr(0, 64)) +
                                             "': no such preset; there are " + names);
}

}  // namespace pursuit::tracker
