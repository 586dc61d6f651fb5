// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/blind_parts.hpp"

#include <Eigen/Core>

namespace pursuit::tracker {
namespace {

// So far ahead of a part none of its own events has come yet.
constexpr double ahead_px = 2.5;

// Pixels that are blind for less than this way hide narrow parts at most; and of slow objects they
// are hardly told (Refractory).
constexpr double least_blind_px = 8;

constexpr double memory = 0.2;

}  // namespace

void look_for_blind_parts(std::int64_t t_us, const Pose& pose, const Velocity& velocity,
                          double radius_px, const RecentPixels& pixels, Outline& outline) {
    // Of many objects most stand: they come over nothing.
    if (velocity == Velocity()) {
        outline.fade_blind(1 - memory);
        return;
    }
    const Eigen::Matrix2d rate_of_d = rate_of_arms(pose.a, velocity);
    const Eigen::Vector2d v(velocity.vx_px_s, velocity.vy_px_s);
    const double least_px_s = least_blind_px / (pixels.blind_us() * 1e-6);
    const double fastest_px_s = v.norm() + rate_of_d.norm() * radius_px;
    if (fastest_px_s < least_px_s) {
        outline.fade_blind(1 - memory);
        return;
    }
    for (Outline::Part& part : outline.parts()) {
        const Eigen::Vector2d d = pose.a * part.middle_px;
        const Eigen::Vector2d speed = v + rate_of_d * d;
        const double px_s = speed.norm();
        bool is_blind = false;
        if (px_s > least_px_s) {
            const double in_s = ahead_px / px_s;
            is_blind = pixels.is_blind(pose.t_px + d + in_s * speed,
                                       static_cast<double>(t_us) + in_s * 1e6);
        }
        outline.set_blind(part, part.blind + memory * ((is_blind ? 1 : 0) - part.blind));
    }
}

}  // namespace pursuit::tracker
