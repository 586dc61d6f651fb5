// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/gaussian_coverage.hpp"

#include <numbers>

namespace pursuit::sensor {
namespace {

double normal_tail(double h) { return 0.5 * std::erfc(h / std::numbers::sqrt2); }

double normal_density(double h) {
    return std::exp(-h * h / 2) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
}

/// Share of the Gaussian in the triangle of corners (0,0), (h,0), (h,t): Simpson's rule over
/// density(s) · (Phi(s t/h) - 1/2), s from 0 to h.
double triangle_share(double h, double t) {
    constexpr int intervals = 24;
    if (h <= 0) return 0;
    double sum = 0;
    for (int i = 0; i <= intervals; ++i) {
        const double s = h * i / intervals;
        const double weight = i == 0 || i == intervals ? 1 : (i % 2 == 1 ? 4 : 2);
        sum += weight * normal_density(s) * (0.5 - normal_tail(s * t / h));
    }
    return sum * h / (3 * intervals);
}

}  // namespace

GaussianCoverage::GaussianCoverage() {
    for (int i = 0; i < tail_size; ++i) {
        tail_[i] = static_cast<float>(normal_tail(static_cast<double>(i) / tail_steps_per_unit));
    }
    for (int i = 0; i < distance_steps + 2; ++i) {
        const double share = static_cast<double>(i) / distance_steps;
        double low = -reach;
        double high = reach;
        for (int k = 0; k < 40; ++k) {
            const double middle = (low + high) / 2;
            (normal_tail(middle) > share ? low : high) = middle;
        }
        distance_[i] = static_cast<float>(high);
    }
    for (int i = 0; i < size; ++i) {
        for (int k = 0; k < size; ++k) {
            triangle_[i][k] = static_cast<float>(triangle_share(
                static_cast<double>(i) / steps_per_unit, static_cast<double>(k) / steps_per_unit));
        }
    }
}

const GaussianCoverage& GaussianCoverage::tables() {
    static const GaussianCoverage tables;
    return tables;
}

}  // namespace pursuit::sensor
