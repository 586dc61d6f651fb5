// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "services/tracker/core/geometry/contour.hpp"

namespace pursuit::tracker {

/// A place of a contour, model frame, and the direction across it, of length 1.
struct ContourSample {
    Eigen::Vector2d at_px;
    Eigen::Vector2d across;
};

/// So many places at equal distances along the contour, or one more or less.
inline std::vector<ContourSample> samples_along(const Contour& contour, double count) {
    std::vector<ContourSample> samples;
    const double step_px = std::max(contour.length_px() / count, 1e-9);
    double along_px = step_px / 2;
    for (const Piece& piece : contour.pieces().pieces()) {
        const Eigen::Vector2d from(piece.ax, piece.ay);
        const Eigen::Vector2d way = Eigen::Vector2d(piece.bx, piece.by) - from;
        const double length_px = way.norm();
        for (; along_px < length_px; along_px += step_px) {
            samples.push_back({from + way * (along_px / length_px),
                               Eigen::Vector2d(way.y(), -way.x()) / length_px});
        }
        along_px -= length_px;
    }
    return samples;
}

}  // namespace pursuit::tracker
