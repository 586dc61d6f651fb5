// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "services/tracker/core/geometry/pose.hpp"

namespace pursuit::experiments {

using Points = std::vector<Eigen::Vector2d>;

/// How a frame is registered to a model.
struct RegistrationSettings {
    tracker::TransformKind transform = tracker::TransformKind::isometry;
    double gate_px = 0;  ///< Points of the frame farther from the model are left out; 0: none is.
    int iterations = 1;  ///< 1: one fit to the nearest points; more: iterated closest point.
    std::size_t least_points = 3;  ///< With fewer the pose stays.
    double share = 1;              ///< How much of the way to the fit the pose goes.
};

/// The least-squares map of `model` onto `image`, pairwise: rigid or similarity as the singular
/// value decomposition gives it (Umeyama 1991), affine by the normal equations. As many points, at
/// least 1; where the points do not tell it, `otherwise`.
tracker::Pose fitted(const Points& model, const Points& image, tracker::TransformKind transform,
                     const tracker::Pose& otherwise);

/// Where `model` is in a frame of points, from where it was: each point is paired with the nearest
/// model point, the pose fitted to the pairs, and again until it rests.
tracker::Pose registered(const Points& model, const Points& frame, tracker::Pose pose,
                         const RegistrationSettings& settings);

}  // namespace pursuit::experiments
