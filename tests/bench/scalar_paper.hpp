// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/geometry/pose.hpp"
#include "services/tracker/core/geometry/shape.hpp"
#include "services/tracker/core/parameters.hpp"

namespace pursuit::tracker::bench {

/// The paper read plainly, for one object that moves and turns: what the tracker's cost is compared
/// with. For each event every model point is looked at (3.1), one number at a time in float64; the
/// nearest within the gate moves the pose (3.2). No contour, no clutter, no occlusion, no life of a
/// track, no record of poses. The event is turned into the model's frame, which costs less than to
/// turn every point into the image and finds the same point.
class ScalarPaper {
 public:
    ScalarPaper(const Shape& shape, const Pose& start, const ObjectParameters& constants)
        : constants_(constants), x_px_(start.t_px.x()), y_px_(start.t_px.y()) {
        turn_to(theta_rad(start.a));
        for (const auto& point : shape.points_px) points_px_.push_back({point.x(), point.y()});
    }

    /// How many of the events moved the pose.
    std::uint64_t process(std::span<const Event> events) {
        std::uint64_t used = 0;
        for (const Event& event : events) used += take(event);
        return used;
    }

    [[nodiscard]] Pose pose() const { return pose_of(x_px_, y_px_, theta_rad_); }

 private:
    struct Point {
        double x, y;
    };

    bool take(const Event& event) {
        const double qx = event.x - x_px_;
        const double qy = event.y - y_px_;
        const double x = cosine_ * qx + sine_ * qy;
        const double y = cosine_ * qy - sine_ * qx;
        double best = 1e300;
        const Point* nearest = nullptr;
        for (const Point& point : points_px_) {
            const double dx = x - point.x;
            const double dy = y - point.y;
            const double squared = dx * dx + dy * dy;
            if (squared < best) {
                best = squared;
                nearest = &point;
            }
        }
        if (best > constants_.gate_px * constants_.gate_px) return false;
        const double mx = cosine_ * nearest->x - sine_ * nearest->y;
        const double my = sine_ * nearest->x + cosine_ * nearest->y;
        x_px_ += 2 * constants_.gradient_position_gain * (qx - mx);
        y_px_ += 2 * constants_.gradient_position_gain * (qy - my);
        turn_to(theta_rad_ + 2 * constants_.gradient_angle_gain_rad_px2 * (mx * qy - my * qx));
        return true;
    }

    void turn_to(double theta_rad) {
        theta_rad_ = theta_rad;
        cosine_ = std::cos(theta_rad);
        sine_ = std::sin(theta_rad);
    }

    ObjectParameters constants_;
    std::vector<Point> points_px_;
    double x_px_;
    double y_px_;
    double theta_rad_ = 0;
    double cosine_ = 1;
    double sine_ = 0;
};

}  // namespace pursuit::tracker::bench
