// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/estimator/bend.hpp"

#include <Eigen/LU>

namespace pursuit::tracker {
namespace {

// A plane that turns about an axis in the image changes b by 1/focal length for each px that its
// contour goes.
constexpr double walk_per_root_px = 0.0025;
// Of both: 45° of tilt, seen from 24 times the radius of gyration.
constexpr double most_variance = 2 * 0.03 * 0.03;
constexpr double most = 0.2;   // of each
constexpr double plainly = 4;  // times the variance of both: b² is told to be more than noise
// The moments of points on a line have no inverse.
constexpr double round_share = 1e-6;

}  // namespace

Bend::Bend(const Contour& contour) : per_gyration_(1 / contour.gyration_px()) {
    // The points' centre of gravity is 0, so that shift and linear part separate.
    Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
    std::array<Eigen::Matrix2d, 2> third{second, second};
    for (const Piece& point : contour.points().pieces()) {
        const Eigen::Vector2d m(point.ax, point.ay);
        second += m * m.transpose();
        third[0] -= m * m.transpose() * (m.x() * per_gyration_);
        third[1] -= m * m.transpose() * (m.y() * per_gyration_);
    }
    const auto count = static_cast<double>(contour.points().pieces().size());
    fields_[0].constant = second.col(0) * (-per_gyration_ / count);
    fields_[1].constant = second.col(1) * (-per_gyration_ / count);
    second.diagonal().array() += round_share * second.trace();
    const Eigen::Matrix2d inverse = second.inverse();
    fields_[0].linear = third[0] * inverse;
    fields_[1].linear = third[1] * inverse;
}

void Bend::restart() {
    b_.setZero();
    covariance_.setZero();
    tell();
}

void Bend::predict(double way_px) {
    covariance_.diagonal().array() += walk_per_root_px * walk_per_root_px * way_px;
    const double variance = covariance_.trace();
    if (variance > most_variance) covariance_ *= most_variance / variance;
}

void Bend::correct(const Eigen::Vector2d& along, double residual_px, double variance_px2,
                   double weight) {
    const Eigen::Vector2d p_h = covariance_ * along;
    const Eigen::Vector2d gain = p_h * (weight / (along.dot(p_h) + variance_px2));
    // The residual is beside the contour as it is told to be bent.
    b_ += gain * (residual_px - along.dot(b_ - told_));
    b_ = b_.cwiseMax(-most).cwiseMin(most);
    covariance_ -= gain * p_h.transpose();
    tell();
}

void Bend::tell() {
    const double told2 = b_.squaredNorm();
    const double doubt2 = plainly * covariance_.trace();
    if (!(told2 > doubt2)) {
        if (is_flat_) return;
        is_flat_ = true;
        told_.setZero();
        told_constant_.setZero();
        told_linear_.setZero();
        return;
    }
    is_flat_ = false;
    told_ = b_ * (1 - doubt2 / told2);
    told_constant_ = told_(0) * fields_[0].constant + told_(1) * fields_[1].constant;
    told_linear_ = told_(0) * fields_[0].linear + told_(1) * fields_[1].linear;
}

}  // namespace pursuit::tracker
