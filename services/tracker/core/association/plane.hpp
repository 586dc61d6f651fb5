// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <optional>

namespace pursuit::tracker {

/// A plane in (x [px], y [px], c·t [px]).
struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d centre_px = Eigen::Vector3d::Zero();  ///< Its third entry from t_us on.
    std::int64_t t_us = 0;
    double px_per_us = 0;  ///< c
    /// rms distance of the events it was laid through: the root of the covariance's smallest
    /// eigenvalue; at least what the pixel grid leaves, 1/√12.
    double sigma_px = 1;

    /// Of the event at (x, y, t), px.
    [[nodiscard]] double distance_px(double x_px, double y_px, std::int64_t at_us) const {
        const Eigen::Vector3d u(x_px, y_px, px_per_us * static_cast<double>(at_us - t_us));
        return std::abs(normal.dot(u - centre_px));
    }
};

/// Number, sums and products of events' (x, y, t), which is all that a principal component analysis
/// needs: an event is added or taken away in constant time. Whole numbers modulo 2^64, so that
/// nothing is rounded: after any number of events the sums are those of the events left, to the
/// bit.
class PlaneSums {
 public:
    void add(std::uint16_t x, std::uint16_t y, std::int64_t t_us);
    void remove(std::uint16_t x, std::uint16_t y, std::int64_t t_us);
    void clear() { *this = {}; }

    [[nodiscard]] std::uint64_t count() const { return n_; }

    /// The plane through the events' mean across their direction of least variance. Nothing where
    /// there are fewer than three. Right as long as all events lie within 10 s of t_us and are
    /// 65,536 at most.
    [[nodiscard]] std::optional<Plane> fit(double px_per_us, std::int64_t t_us) const;

 private:
    std::uint64_t n_ = 0;
    std::uint64_t x_ = 0;
    std::uint64_t y_ = 0;
    std::uint64_t t_ = 0;
    std::uint64_t xx_ = 0;
    std::uint64_t xy_ = 0;
    std::uint64_t yy_ = 0;
    std::uint64_t xt_ = 0;
    std::uint64_t yt_ = 0;
    std::uint64_t tt_ = 0;
};

}  // namespace pursuit::tracker
