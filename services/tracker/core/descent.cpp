// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/descent.hpp"

#include <cmath>

#include "services/tracker/core/motion.hpp"

namespace pursuit::tracker {

void descend(Pose& pose, TransformKind transform, const DescentGains& gains,
             const Eigen::Vector2d& q, const Eigen::Vector2d& m_model, double weight) {
    // (3.2) the model point in the image, about T; the cost is ‖q − m‖².
    const Eigen::Vector2d m = pose.a * m_model;

    if (transform == TransformKind::full_affine) {
        // One case more than the paper's: the gradient of the cost with respect to A itself.
        pose.a += weight * 2 * gains.affine_1_px2 * (q - m) * m_model.transpose();
    } else {
        // (3.7) along the gradient with respect to the angle.
        const double turn_rad = weight * 2 * gains.angle_rad_px2 * (m.x() * q.y() - m.y() * q.x());
        // (3.8)–(3.11) the scales, from the lengths of event and model point; the paper's affine an
        // axis each, in the body's axes.
        if (transform == TransformKind::isometry) {
            Motion<TransformKind::isometry>::Step step;
            step << 0, 0, turn_rad;
            Motion<TransformKind::isometry>::apply(step, pose);
        } else if (transform == TransformKind::similarity) {
            Motion<TransformKind::similarity>::Step step;
            step << 0, 0, turn_rad, weight * gains.scale_1_px * (q.norm() - m.norm());
            Motion<TransformKind::similarity>::apply(step, pose);
        } else {
            const Eigen::Vector2d body_x = pose.a.col(0).normalized();
            const Eigen::Vector2d body_y = pose.a.col(1).normalized();
            Motion<TransformKind::paper_affine>::Step step;
            step << 0, 0, turn_rad,
                weight * gains.scale_1_px * (std::abs(body_x.dot(q)) - std::abs(body_x.dot(m))),
                weight * gains.scale_1_px * (std::abs(body_y.dot(q)) - std::abs(body_y.dot(m)));
            Motion<TransformKind::paper_affine>::apply(step, pose);
        }
    }
    // (3.6) along the gradient with respect to the translation.
    pose.t_px += weight * 2 * gains.position * (q - m);
}

}  // namespace pursuit::tracker
