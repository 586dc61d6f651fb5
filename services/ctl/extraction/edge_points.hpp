// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace pursuit::ctl {

/// A place that many events came from.
struct EdgePoint {
    Eigen::Vector2f position_px;
    float density;              ///< Events around it, weighted by distance.
    float corner;               ///< Smaller eigenvalue of the density's structure tensor around it.
    std::uint8_t polarity = 0;  ///< Of the events.
};

/// Edges in a cloud of events of one polarity that are moved back to one instant: the cloud's
/// ridges, one point a pixel. Isolated events are left out: those with fewer neighbours than 3, or
/// than a quarter of what the median event has. Sorted from dense to thin, then by place: the same
/// events in any order of equal times give the same points.
std::vector<EdgePoint> edge_points(std::span<const Eigen::Vector2f> events_px,
                                   std::uint8_t polarity);

/// The same order for points of both polarities.
bool ranks_before(const EdgePoint& l, const EdgePoint& r);

}  // namespace pursuit::ctl
