// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "filters.pb.h"

namespace pursuit::sensor {

/// A point of the plane at distance 1 before the camera: x right, y down, (0, 0) on its axis.
struct Ray {
    double x = 0;
    double y = 0;
};

/// Where a lens puts the ray of a point, and back. The two models are those of OpenCV's calib3d
/// ("Camera Calibration and 3D Reconstruction"; Kannala and Brandt, PAMI 28 (2006), for FISHEYE).
class Lens {
 public:
    explicit Lens(const disk::Calibration& calibration) : calibration_(calibration) {}

    /// The ray that is seen in direction `ray`, as the lens bends it.
    Ray distort(Ray ray) const;

    /// The ray whose distorted one is `seen`, to 1e-9; none where the model cannot be inverted.
    std::optional<Ray> undistort(Ray seen) const;

 private:
    std::optional<Ray> undistort_fisheye(Ray seen) const;

    disk::Calibration calibration_;
};

}  // namespace pursuit::sensor
