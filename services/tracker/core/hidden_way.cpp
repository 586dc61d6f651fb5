// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/hidden_way.hpp"

#include <cmath>
#include <numbers>

namespace pursuit::tracker {

void HiddenWay::learn(std::int64_t t_us, const Pose& pose) {
    theta_rad_ += std::remainder(theta_rad(pose.a) - theta_rad_, 2 * std::numbers::pi);
    slow_.add(t_us, {pose.t_px.x(), pose.t_px.y(), theta_rad_});
}

void HiddenWay::begin(const Coast& now) {
    coast_ = now;
    const auto slow = slow_.per_s();
    if (!slow.isZero()) coast_.velocity = {slow(0), slow(1), slow(2), 0, 0};
}

void HiddenWay::go_on(std::int64_t t_us, double dt_s, TransformKind transform) {
    coast_.pose.t_px += dt_s * Eigen::Vector2d(coast_.velocity.vx_px_s, coast_.velocity.vy_px_s);
    coast_.pose.a = rotation(coast_.velocity.omega_rad_s * dt_s) * coast_.pose.a;
    constrain(transform);
    coast_.t_us = t_us;
}

void HiddenWay::constrain(TransformKind transform) {
    coast_.pose = constrained(coast_.pose, transform);
}

Pose HiddenWay::pose_at(std::int64_t t_us) const {
    Pose pose = coast_.pose;
    pose.t_px += static_cast<double>(t_us - coast_.t_us) * 1e-6 *
                 Eigen::Vector2d(coast_.velocity.vx_px_s, coast_.velocity.vy_px_s);
    return pose;
}

}  // namespace pursuit::tracker
