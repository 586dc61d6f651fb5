// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/lens.hpp"

#include <cmath>

namespace pursuit::sensor {
namespace {

constexpr int most_steps = 50;
constexpr double close_enough = 1e-9;  // of a focal length: far below a pixel
constexpr double right_angle_rad = 1.5707963267948966;

}  // namespace

Ray Lens::distort(Ray ray) const {
    const auto& c = calibration_;
    const double r2 = ray.x * ray.x + ray.y * ray.y;
    if (c.lens() == disk::Calibration::FISHEYE) {
        const double r = std::sqrt(r2);
        if (r == 0) return ray;
        const double a = std::atan(r);
        const double a2 = a * a;
        const double bent = a * (1 + a2 * (c.k1() + a2 * (c.k2() + a2 * (c.k3() + a2 * c.k4()))));
        return {ray.x * bent / r, ray.y * bent / r};
    }
    const double radial = 1 + r2 * (c.k1() + r2 * (c.k2() + r2 * c.k3()));
    return {ray.x * radial + 2 * c.p1() * ray.x * ray.y + c.p2() * (r2 + 2 * ray.x * ray.x),
            ray.y * radial + c.p1() * (r2 + 2 * ray.y * ray.y) + 2 * c.p2() * ray.x * ray.y};
}

std::optional<Ray> Lens::undistort(Ray seen) const {
    const auto& c = calibration_;
    if (c.lens() == disk::Calibration::FISHEYE) return undistort_fisheye(seen);
    // Newton's method on distort(ray) = seen, from the ray itself.
    Ray ray = seen;
    for (int step = 0; step < most_steps; ++step) {
        const double x = ray.x, y = ray.y, r2 = x * x + y * y;
        const double radial = 1 + r2 * (c.k1() + r2 * (c.k2() + r2 * c.k3()));
        const double slope = c.k1() + r2 * (2 * c.k2() + r2 * 3 * c.k3());  // of radial by r²
        const double xx = radial + 2 * x * x * slope + 2 * c.p1() * y + 6 * c.p2() * x;
        const double xy = 2 * x * y * slope + 2 * c.p1() * x + 2 * c.p2() * y;
        const double yy = radial + 2 * y * y * slope + 6 * c.p1() * y + 2 * c.p2() * x;
        const double determinant = xx * yy - xy * xy;
        // Where it is not positive the lens folds the image over: beyond what it can have seen.
        if (!(determinant > 0) || !(radial > 0)) return std::nullopt;
        const auto at = distort(ray);
        const double dx = seen.x - at.x, dy = seen.y - at.y;
        if (std::hypot(dx, dy) < close_enough) return ray;
        ray.x += (yy * dx - xy * dy) / determinant;
        ray.y += (xx * dy - xy * dx) / determinant;
    }
    return std::nullopt;
}

std::optional<Ray> Lens::undistort_fisheye(Ray seen) const {
    const auto& c = calibration_;
    const double bent = std::hypot(seen.x, seen.y);
    if (bent == 0) return seen;
    double a = bent;
    for (int step = 0; step < most_steps; ++step) {
        const double a2 = a * a;
        const double error =
            a * (1 + a2 * (c.k1() + a2 * (c.k2() + a2 * (c.k3() + a2 * c.k4())))) - bent;
        const double slope =
            1 + a2 * (3 * c.k1() + a2 * (5 * c.k2() + a2 * (7 * c.k3() + a2 * 9 * c.k4())));
        if (!(slope > 0) || !(a > 0) || !(a < right_angle_rad)) return std::nullopt;
        if (std::abs(error) < close_enough) {
            const double r = std::tan(a);
            return Ray{seen.x * r / bent, seen.y * r / bent};
        }
        a -= error / slope;
    }
    return std::nullopt;
}

}  // namespace pursuit::sensor
