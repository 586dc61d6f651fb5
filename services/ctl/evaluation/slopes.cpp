// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/evaluation/slopes.hpp"

#include <cmath>
#include <numbers>

namespace pursuit::ctl {

std::vector<double> slopes(std::span<const double> values, std::size_t half_width, double step_s) {
    const std::size_t width = 2 * half_width + 1;
    if (values.size() < width) return {};
    std::vector<double> weights(width);
    double norm = 0;
    for (std::size_t i = 0; i < width; ++i) {
        weights[i] = (static_cast<double>(i) - static_cast<double>(half_width)) * step_s;
        norm += weights[i] * weights[i];
    }
    std::vector<double> result(values.size() - width + 1);
    for (std::size_t i = 0; i < result.size(); ++i) {
        for (std::size_t k = 0; k < width; ++k) result[i] += weights[k] / norm * values[i + k];
    }
    return result;
}

std::vector<double> unwrapped(std::span<const double> angles_rad) {
    std::vector<double> result(angles_rad.begin(), angles_rad.end());
    for (std::size_t i = 1; i < result.size(); ++i) {
        result[i] = result[i - 1] + wrapped(angles_rad[i] - angles_rad[i - 1]);
    }
    return result;
}

double wrapped(double angle_rad) {
    constexpr double turn = 2 * std::numbers::pi;
    const double shifted = std::fmod(angle_rad + std::numbers::pi, turn);
    return (shifted < 0 ? shifted + turn : shifted) - std::numbers::pi;
}

}  // namespace pursuit::ctl
