// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace pursuit::ctl {

/// Least-squares slopes of values `step_s` apart over ±`half_width` of them, one for each value
/// that the window fits around: values.size() - 2·half_width, in 1/s.
std::vector<double> slopes(std::span<const double> values, std::size_t half_width, double step_s);

/// Angles made continuous: no step of more than π.
std::vector<double> unwrapped(std::span<const double> angles_rad);

/// An angle within -π … π.
double wrapped(double angle_rad);

}  // namespace pursuit::ctl
