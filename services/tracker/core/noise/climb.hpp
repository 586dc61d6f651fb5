// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "services/tracker/core/geometry/coast.hpp"
#include "services/tracker/core/geometry/pose.hpp"

namespace pursuit::tracker {

/// How a climb() goes: steps of 1, ½ and ¼ px, each for some rounds.
struct Climb {
    int most_rounds = 3;
    double velocity_per_s = 1;  ///< Of the velocity a px of step changes so many px/s.
    double turn_rad = 0;        ///< That moves the contour by a px.
};

/// Moves a coast uphill, in place, angle and velocity one after the other, in ever smaller steps.
/// z_of(coast): how high it stands; z: of the coast given, then of the one returned.
template <class ZOf>
[[nodiscard]] Coast climb(Coast coast, double& z, const Climb& how, const ZOf& z_of) {
    for (const double step_px : std::array{1.0, 0.5, 0.25}) {
        const double step_px_s = step_px * how.velocity_per_s;
        bool is_better = true;
        for (int round = 0; round < how.most_rounds && is_better; ++round) {
            is_better = false;
            for (int freedom = 0; freedom < 6; ++freedom) {
                for (const double sign : {1.0, -1.0}) {
                    Coast moved = coast;
                    const double by = sign * step_px;
                    const double by_per_s = sign * step_px_s;
                    if (freedom == 0) moved.pose.t_px.x() += by;
                    if (freedom == 1) moved.pose.t_px.y() += by;
                    if (freedom == 2) moved.pose.a = rotation(by * how.turn_rad) * coast.pose.a;
                    if (freedom == 3) moved.velocity.vx_px_s += by_per_s;
                    if (freedom == 4) moved.velocity.vy_px_s += by_per_s;
                    if (freedom == 5) moved.velocity.omega_rad_s += by_per_s * how.turn_rad;
                    const double moved_z = z_of(moved);
                    if (moved_z <= z) continue;
                    z = moved_z;
                    coast = moved;
                    is_better = true;
                    break;
                }
            }
        }
    }
    return coast;
}

}  // namespace pursuit::tracker
