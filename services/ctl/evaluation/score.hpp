// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pursuit::ctl {

using MaybeNumber = std::optional<double>;

/// How well one object was followed. Lengths in px, times in s; nothing where it does not apply or
/// could not be told. What is compared when: evaluate.hpp.
struct Score {
    std::string object;
    bool lost = true;             ///< Mean error of the last 20 ms above 5 px, or no pose at all.
    std::uint64_t pose_rows = 0;  ///< Read, scored or not.

    MaybeNumber error, error_p95, error_max, error_final;  ///< E: rms over the model's points.
    MaybeNumber error_visible;   ///< While at least half of the shape is in view.
    MaybeNumber error_tracking;  ///< While the tracker says TRACKING.
    MaybeNumber lies, lies_s;    ///< Share, and seconds, of confident poses more than 10 px wrong.
    MaybeNumber tracking_fraction;
    MaybeNumber coverage;  ///< Share of the truth's times that have a pose.
    MaybeNumber x_bias, x_sigma, y_bias, y_sigma, theta_bias, theta_sigma;
    MaybeNumber first_pose_s, first_lost_s, whole_in_view_s;
    MaybeNumber acquired_s;  ///< Begin of the first 20 times in a row tracked within 3 px.

    /// For a shape that has turns of its own: the error over the best of them.
    MaybeNumber symmetric_error, symmetric_error_p95, symmetric_error_max, symmetric_lies;
    std::optional<bool> symmetric_lost;

    MaybeNumber speed_error_pct, velocity_error_pct, omega_error_pct;
    MaybeNumber d1, d1_sigma, d1_events;  ///< The paper's error, from the events.
};

/// A member of Score and what it is called, in JSON and in the table.
struct ScoreField {
    const char* name;
    MaybeNumber Score::*member;
};

const std::vector<ScoreField>& score_fields();

/// One object a member, as {"star": {"lost": false, "E": 0.31, …}, …}; null where there is none.
std::string to_json(const std::vector<Score>& scores);

/// One object a column.
std::string to_table(const std::vector<Score>& scores);

}  // namespace pursuit::ctl
