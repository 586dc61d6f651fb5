// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "services/ctl/extraction/edge_points.hpp"

namespace pursuit::ctl {

/// `most` of the points (in their order of rank), evenly spread: no two of one polarity nearer
/// than a distance that is chosen as small as the number allows. Fewer only where less than that
/// are 1 px apart. Corners, the local maxima of EdgePoint::corner, are taken first, at most a
/// quarter of `most`.
std::vector<EdgePoint> thin(std::span<const EdgePoint> points, std::size_t most);

}  // namespace pursuit::ctl
