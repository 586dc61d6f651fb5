// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/geometry/pose.hpp"

namespace pursuit::tracker {

/// How an object goes as a rule, as it was seen to while most of it showed. What is half hidden
/// tells some of its freedoms by little, and always wrongly in the same way where the model is
/// wrong there: so it is thought to go on as usual. Its velocity strays from that for a while, by
/// as much as it did before.
struct UsualWay {
    /// So much of it must show for this to be learnt; where less does, it holds.
    static constexpr double least_seen_share = 0.7;
    /// For so long the velocity strays. (From a quarter of a second to a whole one it is much the
    /// same.)
    static constexpr double strays_for_s = 0.5;

    Velocity velocity;       ///< Of T and of the angle alone.
    double strays_px_s = 0;  ///< σ, a component; 0: nothing is known.
    double strays_rad_s = 0;

    [[nodiscard]] bool is_known() const { return strays_px_s > 0; }
};

}  // namespace pursuit::tracker
