// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "services/tracker/core/geometry/shape.hpp"

namespace pursuit::ctl {

/// Which of the points a contour joins, told by the events between them: two points to which no
/// third is nearer than they are to each other, where the events around each run along the line
/// between them, and lie along it too. Points in a tangle of events stay without a link.
std::vector<tracker::Edge> contour_links(std::span<const Eigen::Vector2f> points_px,
                                         std::span<const Eigen::Vector2f> events_px);

}  // namespace pursuit::ctl
