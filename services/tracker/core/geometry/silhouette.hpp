// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "services/tracker/core/geometry/contour.hpp"
#include "services/tracker/core/geometry/pose.hpp"

namespace pursuit::tracker {

/// What a shape covers: how deep a place of the model frame lies inside its contour. Gaps of a
/// contour up to 3 px are closed; a contour that encloses nothing covers nothing.
///
/// A map with cells of a pixel or, for large shapes, more: at most 66,049 cells, right to a cell.
class Silhouette {
 public:
    Silhouette() = default;
    explicit Silhouette(const Contour& contour);

    /// Model px to the contour, at most `reach_px`: positive inside, negative outside. Farther than
    /// 4 px, or two cells, outside the shape's circle it is just that far outside.
    [[nodiscard]] double depth_px(const Eigen::Vector2d& m) const {
        const double column = (m.x() - left_px_) * cells_per_px_;
        const double row = (m.y() - top_px_) * cells_per_px_;
        if (!(column >= 0 && row >= 0 && column < columns_ && row < rows_)) return -reach_px;
        return static_cast<double>(
            depth_px_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                      static_cast<std::size_t>(column)]);
    }

    /// The same of a place of the image, under a pose; image px.
    [[nodiscard]] double depth_px(const Eigen::Vector2d& p, const Pose& pose) const {
        const double scale = std::sqrt(std::abs(pose.a.determinant()));
        return depth_px(pose.a.inverse() * (p - pose.t_px)) * scale;
    }

    [[nodiscard]] bool covers_nothing() const { return covers_nothing_; }

    static constexpr double reach_px = 12;

 private:
    double left_px_ = 0;
    double top_px_ = 0;
    double cells_per_px_ = 1;
    int columns_ = 0;
    int rows_ = 0;
    bool covers_nothing_ = true;
    std::vector<float> depth_px_;
};

}  // namespace pursuit::tracker
