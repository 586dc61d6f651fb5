// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/geometry/candidate_grid.hpp"

namespace pursuit::tracker {

/// How far apart the places are at which a contour of this length is drawn into cells, px: at half
/// a pixel each, and what is very long at half a cell, since its cells are large as well.
[[nodiscard]] double drawing_step_px(double length_px, double cell_px);

/// A contour as if it had fired all over: an event in each cell that a FiredMap of this geometry
/// has on it. `from_px`: the model's place that pixel 0, 0 has.
[[nodiscard]] std::vector<Event> drawn_contour(std::span<const Piece> pieces,
                                               const Eigen::Vector2d& from_px, Geometry geometry);

}  // namespace pursuit::tracker
