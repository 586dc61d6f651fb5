// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "services/tracker/core/geometry/pose.hpp"

namespace pursuit::tracker {

/// A pose at a time, and where it goes from there.
struct Coast {
    std::int64_t t_us = 0;
    Pose pose;
    Velocity velocity;

    /// Where it is at a time, before or after, `longest_s` at most: it goes on at its twist, about
    /// the place that a rigid body with this twist turns about.
    [[nodiscard]] Coast at(std::int64_t at_us, double longest_s) const {
        const double dt_s =
            std::clamp(static_cast<double>(at_us - t_us) * 1e-6, -longest_s, longest_s);
        const Eigen::Vector2d v(velocity.vx_px_s, velocity.vy_px_s);
        const double turned_rad = velocity.omega_rad_s * dt_s;
        // Chord of the arc: half way round, and shorter than the arc.
        const double half_rad = turned_rad / 2;
        const double shorter = std::abs(half_rad) < 1e-6 ? 1 : std::sin(half_rad) / half_rad;
        Coast gone = *this;
        gone.t_us = at_us;
        gone.pose.t_px += dt_s * shorter * (rotation(half_rad) * v);
        gone.pose.a = rotation(turned_rad) * pose.a;
        const Eigen::Vector2d turned = rotation(turned_rad) * v;
        gone.velocity.vx_px_s = turned.x();
        gone.velocity.vy_px_s = turned.y();
        return gone;
    }
};

}  // namespace pursuit::tracker
