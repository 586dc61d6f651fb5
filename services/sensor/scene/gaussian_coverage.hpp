// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace pursuit::sensor {

/// How much of a round Gaussian of standard deviation 1 lies on the far side of edges: the exact
/// coverage of a blurred pixel by polygons, from tables.
///
/// The share of the Gaussian about p inside a polygon is the sum over its edges of the signed
/// share of the triangle (p, a, b). With h the distance of p from the edge's line (positive
/// inside) and t the places of a and b along it from the foot of p, that is
///     sum of sign(h) [(angle of the triangle)/2π - G(|h|, t_b) + G(|h|, t_a)],
/// G(h, t) = T(h, t/h) with T Owen's function (Ann. Math. Stat. 27, 1956, p. 1075). The angles add
/// up to the winding number w of the polygon about p, so
///     coverage = w - sum of sign(h) [G(|h|, t_b) - G(|h|, t_a)],
/// in which edges far from p have no part. Absolute error below 1e-4.
class GaussianCoverage {
 public:
    /// Beyond this distance there is nothing: the tail is 3e-5.
    static constexpr float reach = 4;

    GaussianCoverage();

    /// The one set of tables, made at first use.
    static const GaussianCoverage& tables();

    /// Share beyond a straight line at distance h ≥ 0.
    float tail(float h) const {
        if (h >= reach) return 0;
        const float place = h * tail_steps_per_unit;
        const int i = static_cast<int>(place);
        const float u = place - static_cast<float>(i);
        return tail_[i] + u * (tail_[i + 1] - tail_[i]);
    }

    /// The h whose tail is `share`, 0 < share < 1; for the smallest shares `reach`.
    float distance(float share) const {
        const float place = share * distance_steps;
        const int i = static_cast<int>(place);
        const float u = place - static_cast<float>(i);
        return distance_[i] + u * (distance_[i + 1] - distance_[i]);
    }

    /// G(h, t), h ≥ 0, odd in t.
    float edge_part(float h, float t) const {
        const float length = std::abs(t);
        float part = 0;
        if (h >= reach) return 0;
        if (length >= reach) {
            part = tail(h) / 2;
        } else {
            part = angle(length, h) * 0.159154943F - triangle(h, length);
        }
        return t < 0 ? -part : part;
    }

 private:
    /// atan2(y, x) of two numbers that are not negative; error below 2e-5 (Abramowitz and Stegun
    /// 4.4.47).
    static float angle(float y, float x) {
        const float larger = std::max(x, y);
        if (larger <= 0) return 0;
        const float z = std::min(x, y) / larger;
        const float z2 = z * z;
        const float a =
            z * (0.9998660F +
                 z2 * (-0.3302995F + z2 * (0.1801410F + z2 * (-0.0851330F + z2 * 0.0208351F))));
        return y > x ? 1.57079633F - a : a;
    }

    static constexpr int tail_steps_per_unit = 64;
    static constexpr int tail_size = 4 * tail_steps_per_unit + 2;
    static constexpr int distance_steps = 512;
    static constexpr int steps_per_unit = 20;
    static constexpr int size = 4 * steps_per_unit + 2;

    /// Share of the triangle (p, foot, foot + t).
    float triangle(float h, float t) const {
        const float row = h * steps_per_unit;
        const float column = t * steps_per_unit;
        const int i = static_cast<int>(row);
        const int k = static_cast<int>(column);
        const float u = row - static_cast<float>(i);
        const float v = column - static_cast<float>(k);
        const float upper = triangle_[i][k] + v * (triangle_[i][k + 1] - triangle_[i][k]);
        const float lower =
            triangle_[i + 1][k] + v * (triangle_[i + 1][k + 1] - triangle_[i + 1][k]);
        return upper + u * (lower - upper);
    }

    std::array<float, tail_size> tail_{};
    std::array<float, distance_steps + 2> distance_{};
    std::array<std::array<float, size>, size> triangle_{};
};

}  // namespace pursuit::sensor
