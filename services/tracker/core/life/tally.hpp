// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "services/tracker/core/geometry/outline.hpp"
#include "services/tracker/core/geometry/pose.hpp"

namespace pursuit::tracker {

/// How an object goes: a pose's A and the velocity, for all parts of its outline.
class Going {
 public:
    Going(const Eigen::Matrix2d& a, const Velocity& velocity)
        : a_(a), velocity_(velocity), rate_of_arms_(rate_of_arms(a, velocity)) {}

    [[nodiscard]] const Velocity& velocity() const { return velocity_; }
    /// Of a place of the model frame, from the object's own place, image px.
    [[nodiscard]] Eigen::Vector2d arm_px_of(const Eigen::Vector2d& place_px) const {
        return a_ * place_px;
    }
    /// How fast a part with this arm (image) moves across itself, times its length: what makes its
    /// events.
    [[nodiscard]] double across_px_s(const Outline::Part& part,
                                     const Eigen::Vector2d& arm_px) const {
        const Eigen::Vector2d speed =
            Eigen::Vector2d(velocity_.vx_px_s, velocity_.vy_px_s) + rate_of_arms_ * arm_px;
        const Eigen::Vector2d along = a_ * part.along_px;
        return std::abs(along.x() * speed.y() - along.y() * speed.x());
    }
    /// How much of what the motion shows of the outline is not hidden, 0 … 1; radius_px: of the
    /// shape, image.
    [[nodiscard]] double visible_share(const Outline& outline, double radius_px) const;

 private:
    Eigen::Matrix2d a_;
    Velocity velocity_;
    Eigen::Matrix2d rate_of_arms_;
};

/// How many events an object's motion makes: ρ, of contour length times the way across it, learnt
/// from what its outline has counted, a tally after the other. Thread: the tracker's.
class Tally {
 public:
    /// Nothing is known.
    void restart() { *this = Tally(); }
    /// Event time begins anew; what was learnt stays.
    void begin_stream() { t_us_ = -1; }

    /// Whether enough time went by for another one.
    [[nodiscard]] bool is_due(std::int64_t t_us) const { return t_us - t_us_ >= every_us; }
    /// Begins one: it is over the time since the one before.
    void begin(std::int64_t t_us);
    /// Its time; -1 before the first.
    [[nodiscard]] std::int64_t t_us() const { return t_us_; }
    [[nodiscard]] double over_s() const { return over_s_; }

    /// Learns from what came from the parts that are not hidden.
    void learn(const Outline& outline, const Going& going);

    /// How many events a part with this arm (image) should have made in the time that the last one
    /// was over.
    [[nodiscard]] double expected_events(const Going& going, const Outline::Part& part,
                                         const Eigen::Vector2d& arm_px) const {
        return events_per_px2_ * going.across_px_s(part, arm_px) * over_s_;
    }

 private:
    static constexpr std::int64_t every_us = 16'000;
    static constexpr double most_events = 2000;  // ρ is over so many

    double events_per_px2_ = 2;  // ρ
    double events_ = 0;
    double px2_ = 0;
    double over_s_ = 0;
    std::int64_t t_us_ = -1;
};

}  // namespace pursuit::tracker
