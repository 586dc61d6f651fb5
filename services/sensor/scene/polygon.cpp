// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/polygon.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::sensor {
namespace {

constexpr double least_edge_px = 1e-3;

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

double side(const Point& a, const Point& b, const Point& p) { return cross(b - a, p - a); }

bool in_box(const Point& a, const Point& b, const Point& p) {
    return (p.array() >= a.cwiseMin(b).array()).all() && (p.array() <= a.cwiseMax(b).array()).all();
}

bool touch(const Point& a, const Point& b, const Point& c, const Point& d) {
    const double c_side = side(a, b, c);
    const double d_side = side(a, b, d);
    const double a_side = side(c, d, a);
    const double b_side = side(c, d, b);
    if (((c_side > 0) != (d_side > 0)) && ((a_side > 0) != (b_side > 0)) && c_side != 0 &&
        d_side != 0 && a_side != 0 && b_side != 0) {
        return true;
    }
    return (c_side == 0 && in_box(a, b, c)) || (d_side == 0 && in_box(a, b, d)) ||
           (a_side == 0 && in_box(c, d, a)) || (b_side == 0 && in_box(c, d, b));
}

}  // namespace

double doubled_area(const std::vector<Point>& vertices) {
    double sum = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        sum += cross(vertices[i], vertices[(i + 1) % vertices.size()]);
    }
    return sum;
}

void orient(std::vector<Point>& vertices) {
    if (doubled_area(vertices) < 0) std::reverse(vertices.begin(), vertices.end());
}

std::optional<std::string> polygon_error(const std::vector<Point>& v) {
    const std::size_t n = v.size();
    if (n < 3) return "has " + std::to_string(n) + " corners, must have at least 3";
    for (std::size_t i = 0; i < n; ++i) {
        if ((v[(i + 1) % n] - v[i]).norm() < least_edge_px) {
            return "has corner " + std::to_string(i) + " twice";
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 2; j < n; ++j) {
            if (i == 0 && j + 1 == n) continue;
            if (touch(v[i], v[i + 1], v[j], v[(j + 1) % n])) {
                return "crosses itself: the edges from corners " + std::to_string(i) + " and " +
                       std::to_string(j) + " touch";
            }
        }
    }
    if (std::abs(doubled_area(v)) < 1e-2) return "encloses no area";
    return std::nullopt;
}

bool contains(const std::vector<Point>& vertices, const Point& p) {
    bool inside = false;
    for (std::size_t i = 0, j = vertices.size() - 1; i < vertices.size(); j = i++) {
        const Point& a = vertices[i];
        const Point& b = vertices[j];
        if ((a.y() > p.y()) != (b.y() > p.y()) &&
            p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) {
            inside = !inside;
        }
    }
    return inside;
}

}  // namespace pursuit::sensor
