// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/evaluation/interpolation.hpp"

#include <algorithm>

namespace pursuit::ctl {
namespace {

/// Derivative of the parabola through three poses, at the place whose weights are given.
PoseNumbers combine(double a, const PoseNumbers& p, double b, const PoseNumbers& q, double c,
                    const PoseNumbers& r) {
    PoseNumbers sum{};
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = a * p[k] + b * q[k] + c * r[k];
    return sum;
}

PoseNumbers middle_slope(double before, double after, const PoseNumbers& p, const PoseNumbers& q,
                         const PoseNumbers& r) {
    return combine(-after / (before * (before + after)), p, (after - before) / (before * after), q,
                   before / (after * (before + after)), r);
}

PoseNumbers first_slope(double first, double second, const PoseNumbers& p, const PoseNumbers& q,
                        const PoseNumbers& r) {
    return combine(-(2 * first + second) / (first * (first + second)), p,
                   (first + second) / (first * second), q, -first / (second * (first + second)), r);
}

PoseNumbers last_slope(double first, double second, const PoseNumbers& p, const PoseNumbers& q,
                       const PoseNumbers& r) {
    return combine(second / (first * (first + second)), p, -(second + first) / (first * second), q,
                   (2 * second + first) / (second * (first + second)), r);
}

}  // namespace

PoseCurve::PoseCurve(std::span<const double> t_us, std::span<const PoseNumbers> poses)
    : t_us_(t_us), poses_(poses), slopes_(poses.size()) {
    const std::size_t last = poses.size() - 1;
    const auto step = [&](std::size_t i) { return t_us[i + 1] - t_us[i]; };
    if (last == 1) {
        slopes_[0] = combine(-1 / step(0), poses[0], 1 / step(0), poses[1], 0, poses[1]);
        slopes_[1] = slopes_[0];
        return;
    }
    slopes_[0] = first_slope(step(0), step(1), poses[0], poses[1], poses[2]);
    for (std::size_t i = 1; i < last; ++i) {
        slopes_[i] = middle_slope(step(i - 1), step(i), poses[i - 1], poses[i], poses[i + 1]);
    }
    slopes_[last] =
        last_slope(step(last - 2), step(last - 1), poses[last - 2], poses[last - 1], poses[last]);
}

PoseNumbers PoseCurve::at(double t_us) const {
    t_us = std::clamp(t_us, t_us_.front(), t_us_.back());
    const auto after = std::clamp<std::size_t>(count_up_to(t_us_, t_us), 1, t_us_.size() - 1);
    const std::size_t i = after - 1;
    const double h = t_us_[i + 1] - t_us_[i];
    const double u = (t_us - t_us_[i]) / h;
    const double u2 = u * u;
    const double u3 = u2 * u;
    PoseNumbers value{};
    for (std::size_t k = 0; k < value.size(); ++k) {
        value[k] = (2 * u3 - 3 * u2 + 1) * poses_[i][k] + (u3 - 2 * u2 + u) * slopes_[i][k] * h +
                   (3 * u2 - 2 * u3) * poses_[i + 1][k] + (u3 - u2) * slopes_[i + 1][k] * h;
    }
    return value;
}

std::size_t count_up_to(std::span<const double> times, double t) {
    return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) -
                                    times.begin());
}

}  // namespace pursuit::ctl
