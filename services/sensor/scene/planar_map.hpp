// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace pursuit::sensor {

using Point = Eigen::Vector2d;

/// A map of the plane to the plane that keeps straight lines straight: an affine map, or the view
/// of a tilted plane. Homogeneous, the last entry 1; positive denominators wherever it is used.
struct PlanarMap {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();

    Point operator*(const Point& p) const {
        const Eigen::Vector3d q = matrix.col(0) * p.x() + matrix.col(1) * p.y() + matrix.col(2);
        return q.head<2>() / q.z();
    }

    PlanarMap operator*(const PlanarMap& inner) const { return {matrix * inner.matrix}; }

    bool operator==(const PlanarMap& other) const { return matrix == other.matrix; }
};

}  // namespace pursuit::sensor
