// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "services/tracker/core/geometry/contour.hpp"

namespace pursuit::tracker {

/// How the view of a tilted plane departs from the affine map that fits it best. In perspective a
/// model point m is seen at A·m / (1 + b·m/r), r the radius of gyration: to first order in b at
/// A·(m + shift(m)), shift(m) = −m·(b·m)/r less the affine map nearest to this at the model's
/// points. So the pose beside a bend is the best affine fit of the view, and not what the part of
/// the contour that moves most makes of it.
///
/// b is learnt from the residuals that the filter of the pose leaves, by a filter of its own, as a
/// random walk over the way gone. It is held to be flat, exactly, until b is plainly more than its
/// uncertainty: what blurs or rounds a contour looks a little bent, too, and where nothing is bent
/// two freedoms more would cost precision.
class Bend {
 public:
    explicit Bend(const Contour& contour);

    /// Flat, and known to be.
    void restart();

    /// The object moved by way_px of image.
    void predict(double way_px);

    [[nodiscard]] bool is_flat() const { return is_flat_; }

    /// Where a point of the model, or one near it, is seen, less m; model px. 0 where it is flat.
    [[nodiscard]] Eigen::Vector2d shift(const Eigen::Vector2d& m) const {
        return -m * told_.dot(m) * per_gyration_ - told_constant_ - told_linear_ * m;
    }

    /// d(g·shift(m))/db, where g takes a step in the model to what is measured: Aᵀ·n.
    [[nodiscard]] Eigen::Vector2d along(const Eigen::Vector2d& g, const Eigen::Vector2d& m) const {
        const double out = -g.dot(m) * per_gyration_;
        return {out * m.x() - g.dot(fields_[0].constant + fields_[0].linear * m),
                out * m.y() - g.dot(fields_[1].constant + fields_[1].linear * m)};
    }

    /// Corrects by a residual r beside the bent contour, whose variance without b is given; weight
    /// 0 … 1 scales gain and reduction.
    void correct(const Eigen::Vector2d& along, double residual_px, double variance_px2,
                 double weight);

 private:
    void tell();

    /// The affine map nearest to −m·mᵢ/r: constant + linear·m.
    struct Field {
        Eigen::Vector2d constant = Eigen::Vector2d::Zero();
        Eigen::Matrix2d linear = Eigen::Matrix2d::Zero();
    };
    std::array<Field, 2> fields_;
    double per_gyration_ = 0;

    Eigen::Vector2d b_ = Eigen::Vector2d::Zero();
    Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Zero();

    // What is told of b, and its field.
    bool is_flat_ = true;
    Eigen::Vector2d told_ = Eigen::Vector2d::Zero();
    Eigen::Vector2d told_constant_ = Eigen::Vector2d::Zero();
    Eigen::Matrix2d told_linear_ = Eigen::Matrix2d::Zero();
};

}  // namespace pursuit::tracker
