// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/common/event.hpp"
#include "services/common/result.hpp"
#include "services/ctl/evaluation/score.hpp"
#include "services/ctl/evaluation/track_table.hpp"

namespace pursuit::ctl {

using ModelPoints = std::vector<Eigen::Vector2d>;

struct EvaluationSettings {
    double from_s = 0.2;  ///< Scored from here …
    double to_s = 0;      ///< … to here; 0: to the end.
    /// Up to this age a pose is compared with the truth at its own time, so that publishing on a
    /// grid is no error; an older one with the truth at the present: silence is an error.
    double fresh_ms = 2;
    double speed_window_s = 0.1;          ///< Half width of the slopes; 0: no speed error.
    std::map<std::string, int> symmetry;  ///< Turns that map a shape onto itself, by model name.
};

/// Scores poses against the truth.
///
/// At every time of the truth the last pose is held. Rows before an object's first TRACKING or
/// OCCLUDED row are no pose, and the truth before that row is not scored. A row whose numbers are
/// not finite holds the pose before it, but its state counts. Objects are matched by model name, or
/// by object id where no name of the poses is one of the models. `events` adds D1, the paper's
/// error: over windows of 200 us, the mean distance of the window's events that are within 6 px to
/// the nearest point of the model, at the pose of the window's end. Truth that is not whole is an
/// error, and so is a scored range in which none of it lies.
Result<std::vector<Score>> evaluate(const std::vector<ObjectRows>& poses,
                                    const std::vector<ObjectRows>& truth,
                                    const std::map<std::string, ModelPoints>& models,
                                    const std::vector<Event>* events,
                                    const EvaluationSettings& settings);

}  // namespace pursuit::ctl
