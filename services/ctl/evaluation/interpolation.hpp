// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "services/ctl/evaluation/track_table.hpp"

namespace pursuit::ctl {

/// Cubic interpolation of poses given at rising times; clamped to the ends. Slopes are second-order
/// differences, one-sided at the ends; at least two poses.
class PoseCurve {
 public:
    PoseCurve(std::span<const double> t_us, std::span<const PoseNumbers> poses);

    PoseNumbers at(double t_us) const;

 private:
    std::span<const double> t_us_;
    std::span<const PoseNumbers> poses_;
    std::vector<PoseNumbers> slopes_;
};

/// How many of the rising `times` are at or before `t`.
std::size_t count_up_to(std::span<const double> times, double t);

}  // namespace pursuit::ctl
