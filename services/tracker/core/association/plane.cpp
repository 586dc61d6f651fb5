// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/plane.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace pursuit::tracker {
namespace {

// Variance of a place that is rounded to a pixel, px².
constexpr double pixel_variance_px2 = 1.0 / 12;

double signed_value(std::uint64_t modular) {
    return static_cast<double>(static_cast<std::int64_t>(modular));
}

}  // namespace

void PlaneSums::add(std::uint16_t x_px, std::uint16_t y_px, std::int64_t t_us) {
    const std::uint64_t x = x_px;
    const std::uint64_t y = y_px;
    const auto t = static_cast<std::uint64_t>(t_us);
    ++n_;
    x_ += x;
    y_ += y;
    t_ += t;
    xx_ += x * x;
    xy_ += x * y;
    yy_ += y * y;
    xt_ += x * t;
    yt_ += y * t;
    tt_ += t * t;
}

void PlaneSums::remove(std::uint16_t x_px, std::uint16_t y_px, std::int64_t t_us) {
    const std::uint64_t x = x_px;
    const std::uint64_t y = y_px;
    const auto t = static_cast<std::uint64_t>(t_us);
    --n_;
    x_ -= x;
    y_ -= y;
    t_ -= t;
    xx_ -= x * x;
    xy_ -= x * y;
    yy_ -= y * y;
    xt_ -= x * t;
    yt_ -= y * t;
    tt_ -= t * t;
}

std::optional<Plane> PlaneSums::fit(double px_per_us, std::int64_t t_us) const {
    if (n_ < 3) return std::nullopt;
    // About t_us; what wrapped around on the way comes back, since the results fit: at most 65,536
    // events times (10 s)² is below 2^63 µs².
    const auto from = static_cast<std::uint64_t>(t_us);
    const double n = static_cast<double>(n_);
    const double xt = signed_value(xt_ - from * x_);
    const double yt = signed_value(yt_ - from * y_);
    const double tt = signed_value(tt_ - 2 * from * t_ + from * from * n_);
    const Eigen::Vector3d mean = Eigen::Vector3d(static_cast<double>(x_), static_cast<double>(y_),
                                                 px_per_us * signed_value(t_ - from * n_)) /
                                 n;
    Eigen::Matrix3d covariance;
    covariance << static_cast<double>(xx_), static_cast<double>(xy_), px_per_us * xt,  //
        static_cast<double>(xy_), static_cast<double>(yy_), px_per_us * yt,            //
        px_per_us * xt, px_per_us * yt, px_per_us * px_per_us * tt;
    covariance = covariance / n - mean * mean.transpose();

    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> components;
    components.computeDirect(covariance);
    Plane plane;
    plane.normal = components.eigenvectors().col(0);
    plane.centre_px = mean;
    plane.t_us = t_us;
    plane.px_per_us = px_per_us;
    plane.sigma_px = std::sqrt(std::max(components.eigenvalues()(0), pixel_variance_px2));
    return plane;
}

}  // namespace pursuit::tracker
