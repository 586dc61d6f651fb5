// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/hidden_way.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pursuit::tracker {
namespace {

constexpr double most_samples = 50;  // a memory of the slow velocity
constexpr double least_samples = 25;
// Nothing is known to go more steadily than that: a share of its speed, and what the pose strays.
constexpr double strays_share = 0.03;
constexpr double strays_least_px_s = 0.3;

}  // namespace

void HiddenWay::learn(std::int64_t t_us, const Pose& pose) {
    theta_rad_ += std::remainder(theta_rad(pose.a) - theta_rad_, 2 * std::numbers::pi);
    const Eigen::Vector3d now(pose.t_px.x(), pose.t_px.y(), theta_rad_);
    slow_.add(t_us, now);
    quick_.add(t_us, now);
    const Eigen::Vector3d strays = quick_.per_s() - slow_.per_s();
    samples_ = std::min(samples_ + 1, most_samples);
    strays2_px2_s2_ += (strays.head<2>().squaredNorm() / 2 - strays2_px2_s2_) / samples_;
    strays2_rad2_s2_ += (strays(2) * strays(2) - strays2_rad2_s2_) / samples_;
}

void HiddenWay::learn_anew() {
    const Coast coast = coast_;
    restart();
    coast_ = coast;
}

UsualWay HiddenWay::usual() const {
    UsualWay way;
    if (samples_ < least_samples) return way;
    const auto slow = slow_.per_s();
    way.velocity = {slow(0), slow(1), slow(2), 0, 0};
    way.strays_px_s =
        std::sqrt(strays2_px2_s2_) + strays_share * slow.head<2>().norm() + strays_least_px_s;
    way.strays_rad_s = std::sqrt(strays2_rad2_s2_) + strays_share * std::abs(slow(2));
    return way;
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
