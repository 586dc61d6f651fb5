// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "services/tracker/core/geometry/coast.hpp"
#include "services/tracker/core/pose_record.hpp"

namespace pursuit::tracker {

/// The last poses that the events agreed with, to go on from when they do not any more: from the
/// one before the last, which is older than what made them disagree. Thread: the tracker's.
class GoodPoses {
 public:
    /// Nothing agreed yet; it is thought to be here.
    void begin_at(const Pose& pose, const Velocity& velocity) { set({none_us, pose, velocity}); }
    /// Of both nothing else is known than this.
    void set(const Coast& good) { last_ = before_ = good; }
    /// It is lost now: without a good pose it coasts from now on.
    void coast_from(std::int64_t t_us) {
        if (before_.t_us < 0) before_.t_us = t_us;
    }
    /// The poses are constrained otherwise from now on.
    void constrain(TransformKind kind) {
        for (Coast* good : {&last_, &before_}) good->pose = constrained(good->pose, kind);
    }

    /// Whether another one is wanted.
    [[nodiscard]] bool is_due(std::int64_t t_us) const {
        return last_.t_us < 0 || t_us - last_.t_us >= every_us;
    }
    /// What is known now. A velocity less than its own uncertainty is none: an object that stands
    /// does not coast off.
    void add(const PoseRecord& now) {
        Coast good{now.t_us, now.pose, now.velocity};
        Velocity& v = good.velocity;
        const auto& of_v = now.velocity_covariance;
        if (v.vx_px_s * v.vx_px_s + v.vy_px_s * v.vy_px_s < of_v[0] + of_v[3]) {
            v.vx_px_s = v.vy_px_s = 0;
        }
        if (v.omega_rad_s * v.omega_rad_s < of_v[5]) v.omega_rad_s = 0;
        before_ = last_.t_us < 0 ? good : last_;
        last_ = good;
    }

    /// To coast from.
    [[nodiscard]] const Coast& before() const { return before_; }

 private:
    static constexpr std::int64_t every_us = 30'000;
    static constexpr std::int64_t none_us = -1;

    Coast last_;
    Coast before_;
};

}  // namespace pursuit::tracker
