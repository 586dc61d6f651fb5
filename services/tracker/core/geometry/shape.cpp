// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/geometry/shape.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::tracker {
namespace {

bool is_name_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '-';
}

/// `field`: as a file of the model names it (idl/model.proto).
tl::unexpected<Error> in_model(const std::string& field, const std::string& message) {
    return tl::unexpected<Error>(Error{message, field});
}

}  // namespace

Result<void> check_name(std::string_view name) {
    if (name.empty() || name.size() > max_name_length) {
        return in_model("name",
                        "name: has " + std::to_string(name.size()) + " characters, not 1 to 63");
    }
    if (!std::all_of(name.begin(), name.end(), is_name_character)) {
        return in_model("name", "name: has a character other than A-Z, a-z, 0-9, '_', '.' and '-'");
    }
    return {};
}

Result<void> check(const Shape& shape) {
    if (auto named = check_name(shape.name); !named) return named;
    const std::size_t count = shape.points_px.size();
    if (count < min_shape_points || count > max_shape_points) {
        return fail("points: has " + std::to_string(count) + " points, not 3 to 4096");
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector2f& point = shape.points_px[i];
        if (!point.allFinite() || point.cwiseAbs().maxCoeff() > max_shape_coordinate_px) {
            return in_model("point[" + std::to_string(i) + "]",
                            "points[" + std::to_string(i) +
                                "]: a coordinate is not a number within -4096 to 4096 px");
        }
    }
    const Eigen::Vector2f first = shape.points_px.front();
    const bool has_extent =
        std::any_of(shape.points_px.begin(), shape.points_px.end(),
                    [&](const Eigen::Vector2f& point) { return (point - first).norm() > 1.0F; });
    if (!has_extent)
        return fail("points: all lie within 1 px of the first, the shape has no extent");
    if (shape.edges.size() > max_shape_edges) {
        return fail("edges: has " + std::to_string(shape.edges.size()) +
                    " edges, not at most 4096");
    }
    for (std::size_t i = 0; i < shape.edges.size(); ++i) {
        const Edge& edge = shape.edges[i];
        if (edge.from >= count || edge.to >= count || edge.from == edge.to) {
            return in_model("edge[" + std::to_string(i) + "]",
                            "edges[" + std::to_string(i) + "]: joins points " +
                                std::to_string(edge.from) + " and " + std::to_string(edge.to) +
                                ", not two different ones of 0 to " + std::to_string(count - 1));
        }
    }
    return {};
}

Eigen::Vector2d centre_of_gravity_px(const Shape& shape) {
    Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2f& point : shape.points_px) sum_px += point.cast<double>();
    return sum_px / static_cast<double>(std::max<std::size_t>(1, shape.points_px.size()));
}

Shape centred(Shape shape) {
    const Eigen::Vector2d centre_px = centre_of_gravity_px(shape);
    float extent_px = 0;
    for (const Eigen::Vector2f& point : shape.points_px) {
        extent_px = std::max(extent_px, point.cwiseAbs().maxCoeff());
    }
    // Rounding the centred points to float moves their mean by at most 2^-24 of the extent.
    if (centre_px.cwiseAbs().maxCoeff() <= std::ldexp(extent_px, -23)) return shape;
    for (Eigen::Vector2f& point : shape.points_px) {
        point = (point.cast<double>() - centre_px).cast<float>();
    }
    return shape;
}

}  // namespace pursuit::tracker
