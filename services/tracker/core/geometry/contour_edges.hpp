// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/tracker/core/geometry/shape.hpp"

namespace pursuit::tracker {

/// The shape with points that lie on each other, within a ten-thousandth of its radius, as one: the
/// first of them. Edges between these are left out, and edges that come twice.
Shape without_repeats(const Shape& shape);

/// The edges that a contour without edges gets: neighbours to which no third point is nearer (the
/// relative neighbourhood graph), unless far apart. Of points that do not lie on each other: of
/// those it takes as many steps as the cube of their number.
std::vector<Edge> inferred_edges(const std::vector<Eigen::Vector2f>& points_px);

}  // namespace pursuit::tracker
