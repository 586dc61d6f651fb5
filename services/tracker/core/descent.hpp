// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "services/tracker/core/pose.hpp"
#include "services/tracker/core/registration.hpp"

namespace pursuit::tracker {

/// The paper's gains: eta1 [1], eta2 [rad/px²], eta3 [1/px], and one for the full affine [1/px²].
struct DescentGains {
    double position = 0;
    double angle_rad_px2 = 0;
    double scale_1_px = 0;
    double affine_1_px2 = 0;
};

/// One event's step of the paper's gradient descent, section 3.2: the pose moves so that the model
/// point nearest to the event comes nearer to it.
///   q        the event about T, image px
///   m_model  the nearest model point, model px
///   weight   0 … 1, of the step
void descend(Pose& pose, TransformKind transform, const DescentGains& gains,
             const Eigen::Vector2d& q, const Eigen::Vector2d& m_model, double weight);

}  // namespace pursuit::tracker
