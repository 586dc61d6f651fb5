// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "services/tracker/core/geometry/candidate_grid.hpp"
#include "services/tracker/core/kinds.hpp"

namespace pursuit::tracker {

/// The place of a contour that is nearest to an event.
struct ContourPlace {
    std::int32_t piece = -1;   ///< -1: none within reach.
    Eigen::Vector2d model_px;  ///< In the model frame.
    Eigen::Vector2d arm_px;    ///< In the image, about T.
    Eigen::Vector2d n;         ///< The contour's unit normal there, image.
    double turning_px = 0;     ///< How far the place goes along n in a turn by a radian.
    double line_px = 0;        ///< Along n, from T to the line through the piece.
    double r_px = 0;           ///< Along it, from the place to the event.
    double squared_px = 0;     ///< The distance, squared.
};

/// Nearest in the image, under A of this kind of transform; q: the event about T, image px. The
/// pieces must be built for reach_px.
template <TransformKind kind>
[[nodiscard, gnu::always_inline]] inline ContourPlace place_on_contour(const CandidateGrid& pieces,
                                                                       const Eigen::Matrix2d& a,
                                                                       const Eigen::Vector2d& q,
                                                                       double reach_px) {
    ContourPlace place;
    CandidateGrid::Nearest nearest;
    if constexpr (kind == TransformKind::isometry || kind == TransformKind::similarity) {
        // What is nearest in the image is so in the model frame; the inverse of A is its transpose,
        // but for the scale.
        double x = a(0, 0) * q.x() + a(1, 0) * q.y();
        double y = a(0, 0) * q.y() - a(1, 0) * q.x();
        double scale2 = 1;
        if constexpr (kind == TransformKind::similarity) {
            scale2 = a(0, 0) * a(0, 0) + a(1, 0) * a(1, 0);
            x /= scale2;
            y /= scale2;
        }
        nearest = pieces.nearest(x, y, ModelMetric());
        if (nearest.piece < 0) return place;
        nearest.squared_px *= scale2;
        // As far from the piece's line as from any place of it: that is known first.
        const Segment& segment = pieces.segment(nearest.piece);
        place.r_px = segment.nx * (x - segment.ax) + segment.ny * (y - segment.ay);
        place.n << a(0, 0) * segment.nx - a(1, 0) * segment.ny,
            a(1, 0) * segment.nx + a(0, 0) * segment.ny;
        place.line_px = segment.line;
        if constexpr (kind == TransformKind::similarity) {
            const double scale = std::sqrt(scale2);
            place.r_px *= scale;
            place.n /= scale;
            place.line_px *= scale;
        }
    } else {
        const double per_area = 1 / (a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0));
        nearest = pieces.nearest((a(1, 1) * q.x() - a(0, 1) * q.y()) * per_area,
                                 (a(0, 0) * q.y() - a(1, 0) * q.x()) * per_area, ImageMetric(a));
        if (nearest.piece < 0) return place;
        const Segment& segment = pieces.segment(nearest.piece);
        const Eigen::Vector2d along = a * Eigen::Vector2d(segment.dx, segment.dy);
        const double per_length = 1 / along.norm();
        place.n << along.y() * per_length, -along.x() * per_length;
        place.line_px = place.n.dot(a * Eigen::Vector2d(segment.ax, segment.ay));
        place.r_px = place.n.dot(q) - place.line_px;
    }
    if (!(nearest.squared_px <= reach_px * reach_px)) return place;
    place.piece = nearest.piece;
    place.squared_px = nearest.squared_px;
    const Segment& segment = pieces.segment(nearest.piece);
    place.model_px << segment.ax + nearest.foot * segment.dx,
        segment.ay + nearest.foot * segment.dy;
    place.arm_px = a * place.model_px;
    if constexpr (kind == TransformKind::isometry) {
        // (The same in either frame, and there it is known first.)
        place.turning_px = segment.ny * place.model_px.x() - segment.nx * place.model_px.y();
    } else {
        place.turning_px = place.n.y() * place.arm_px.x() - place.n.x() * place.arm_px.y();
    }
    if (!(segment.per_length2 > 0)) {
        // A point: from it to the event.
        place.r_px = std::sqrt(place.squared_px);
        place.n = place.r_px > 1e-9 ? Eigen::Vector2d((q - place.arm_px) / place.r_px)
                                    : Eigen::Vector2d(1, 0);
        place.turning_px = place.n.y() * place.arm_px.x() - place.n.x() * place.arm_px.y();
        place.line_px = place.n.dot(place.arm_px);
    }
    return place;
}

}  // namespace pursuit::tracker
