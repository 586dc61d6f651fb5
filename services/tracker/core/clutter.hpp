// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "services/tracker/core/contour.hpp"

namespace pursuit::tracker {

/// How many of the events near an object's contour are not its own, measured: the density of events
/// beside the contour, on each side, against those on it.
class Clutter {
 public:
    static constexpr double near_px = 4;        ///< On the contour: |r| below.
    static constexpr double far_from_px = 3.5;  ///< Beside it: |r| between these two.
    static constexpr double far_to_px = 6.5;

    void restart();

    /// Measures the areas of the bands around the contour under A.
    void sample(const Contour& contour, const Eigen::Matrix2d& a);

    /// Time goes on: to be called before the events of a time are counted.
    void reach(std::int64_t t_us) {
        near_time_us_ += static_cast<double>(t_us - t_us_);
        t_us_ = t_us;
        if (t_us >= fold_at_us_ || near_time_us_ > slack_us_) fold(t_us);
    }

    /// An event beside the contour at signed distance r.
    void count_far(double r_px);
    /// An event on the contour that is the object's with probability `share`.
    void count_near(double share);

    /// Density of clutter over r at this side of the contour, 1/px, beside a density of 1 for the
    /// object's own events.
    [[nodiscard]] double density(double r_px) const {
        return std::max(density_[r_px > 0], standing_density_[r_px > 0]);
    }

    /// The measured share of the events on the contour that are the object's, 0 … 1.
    [[nodiscard]] double own_share() const { return own_share_; }

 private:
    void close_window();
    void fold(std::int64_t t_us);

    static constexpr double window_events = 300;
    static constexpr double floor = 0.002;

    std::array<double, 2> far_area_px2_{1, 1};
    std::array<double, 2> near_width_px_{1, 1};  // area of the near band over its width
    std::array<double, 2> far_events_{};
    double near_events_ = 0;
    double own_events_ = 0;
    double events_ = 0;
    std::array<double, 2> density_{floor, floor};  // over the last events

    // Over the last time. When an object stops, its events end and those beside it do not: what
    // then comes is known for clutter before enough of it was counted.
    std::array<double, 2> new_far_{};
    std::array<double, 2> far_hz_{};
    double near_count_ = 0;    // the last ten or so on the contour …
    double near_time_us_ = 0;  // … and the time they took
    double slack_us_ = 0;      // silence after which the density is told anew
    std::int64_t t_us_ = 0;
    std::int64_t folded_us_ = 0;
    std::int64_t fold_at_us_ = 0;
    std::array<double, 2> standing_density_{floor, floor};
    double own_share_ = 1;
};

}  // namespace pursuit::tracker
