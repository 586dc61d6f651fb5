// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "services/common/result.hpp"

namespace pursuit::tracker {

/// A piece of contour between two points, by their index from 0.
struct Edge {
    std::uint16_t from = 0;
    std::uint16_t to = 0;

    friend bool operator==(const Edge&, const Edge&) = default;
};

/// What an object looks like: points along its contours, px, x right and y down, and optionally
/// which of them a contour joins. 32-bit floats, as on the wire and on disk, so that every copy is
/// the same.
struct Shape {
    std::string name;
    std::vector<Eigen::Vector2f> points_px;
    std::vector<Edge> edges;

    friend bool operator==(const Shape&, const Shape&) = default;
};

constexpr std::size_t min_shape_points = 3;
constexpr std::size_t max_shape_points = 4096;
constexpr std::size_t max_shape_edges = 4096;
constexpr float max_shape_coordinate_px = 4096;
constexpr std::size_t max_name_length = 63;

/// A name of 1 … 63 characters of [A-Za-z0-9_.-].
Result<void> check_name(std::string_view name);

/// Refuses a shape with a bad name, fewer than 3 or more than 4096 points, a coordinate that is not
/// finite or beyond ±4096 px, points that all lie within 1 px, more than 4096 edges, or an edge to
/// a point that is not there or to itself.
Result<void> check(const Shape& shape);

/// The shape about its centre of gravity, the mean of its points. A shape that is there already,
/// within the rounding of its own floats, comes back unchanged: centred(centred(s)) equals
/// centred(s) bit for bit.
Shape centred(Shape shape);

/// What centred() subtracts, px: where the model frame's origin lies in the frame of `shape`.
Eigen::Vector2d centre_of_gravity_px(const Shape& shape);

}  // namespace pursuit::tracker
