// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "services/tracker/core/geometry/motion.hpp"
#include "services/tracker/core/geometry/pose.hpp"
#include "services/tracker/core/registration.hpp"

namespace pursuit::tracker {

/// The paper's gains: eta1 [1], eta2 [rad/px²], eta3 [1/px], and one for the full affine [1/px²].
struct DescentGains {
    double position = 0;
    double angle_rad_px2 = 0;
    double scale_1_px = 0;
    double affine_1_px2 = 0;
};

/// The step of an isometry, in which lengths and angles are the same in the model's frame: nothing
/// has to be turned before it is known where the event pulls, and the next event waits for less.
///   off      from the nearest model point to the event, in the model's frame
[[gnu::always_inline]] inline void descend_rigidly(Pose& pose, const DescentGains& gains,
                                                   const Eigen::Vector2d& off,
                                                   const Eigen::Vector2d& m_model, double weight) {
    // (3.2) the cost is ‖off‖².
    // (3.7) along the gradient with respect to the angle; m × x is m × (x − m).
    const double turn =
        weight * 2 * gains.angle_rad_px2 * (m_model.x() * off.y() - m_model.y() * off.x());
    // (3.6) along the gradient with respect to the translation.
    pose.t_px += pose.a * (weight * 2 * gains.position * off);
    Motion<TransformKind::isometry>::turn(turn, pose.a);
}

/// One event's step of the paper's gradient descent, section 3.2: the pose moves so that the model
/// point nearest to the event comes nearer to it.
///   q        the event about T, image px
///   m_model  the nearest model point, model px
///   weight   0 … 1, of the step
template <TransformKind kind>
[[gnu::always_inline]] inline void descend(Pose& pose, const DescentGains& gains,
                                           const Eigen::Vector2d& q, const Eigen::Vector2d& m_model,
                                           double weight) {
    if constexpr (kind == TransformKind::isometry) {
        descend_rigidly(pose, gains, pose.a.transpose() * q - m_model, m_model, weight);
    } else {
        // (3.2) the model point in the image, about T; the cost is ‖q − m‖².
        const Eigen::Vector2d m = pose.a * m_model;
        const Eigen::Vector2d off = q - m;
        if constexpr (kind == TransformKind::full_affine) {
            // One case more than the paper's: the gradient of the cost with respect to A itself.
            pose.a += weight * 2 * gains.affine_1_px2 * off * m_model.transpose();
        } else {
            typename Motion<kind>::Step step;
            // (3.7) along the gradient with respect to the angle.
            const double turn = weight * 2 * gains.angle_rad_px2 * (m.x() * q.y() - m.y() * q.x());
            // (3.8)–(3.11) the scales, from the lengths of event and model point; the paper's
            // affine an axis each, in the body's axes.
            if constexpr (kind == TransformKind::similarity) {
                step << 0, 0, turn, weight * gains.scale_1_px * (q.norm() - m.norm());
            } else {
                const auto longer = [&](const Eigen::Vector2d& body) {
                    return std::abs(body.dot(q)) - std::abs(body.dot(m));
                };
                const double gain = weight * gains.scale_1_px;
                step << 0, 0, turn, gain * longer(pose.a.col(0).normalized()),
                    gain * longer(pose.a.col(1).normalized());
            }
            Motion<kind>::apply(step, pose);
        }
        // (3.6) along the gradient with respect to the translation.
        pose.t_px += weight * 2 * gains.position * off;
    }
}

}  // namespace pursuit::tracker
