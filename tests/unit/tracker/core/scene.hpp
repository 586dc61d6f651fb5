// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/pose_record.hpp"
#include "services/tracker/core/registration.hpp"
#include "services/tracker/core/search/search_range.hpp"
#include "services/tracker/core/tracker.hpp"

namespace pursuit::tracker::test {

/// The geometry of a small sensor.
inline constexpr Geometry small_sensor{304, 240};

/// Any place, turn and size in its image.
inline SearchRange anywhere() {
    SearchRange range;
    range.around.t_px << 152, 120;
    range.reach_px = 304;
    range.angle_rad = std::numbers::pi;
    range.log_scale = 0.27;
    range.usual_distance_px = 1e6;
    return range;
}

/// Keeps what the tracker hands over.
struct Poses : PoseSink {
    struct Row {
        PoseRecord record;
        std::string model;
    };

    void pose(const PoseRecord& record) override {
        rows.push_back({record, std::string(record.model)});
    }
    void update(const UpdateRecord& record) override { updates.push_back(record); }

    std::vector<Row> rows;
    std::vector<UpdateRecord> updates;
};

/// The contour of a polygon, a point every px or so, with its edges.
inline Shape polygon(std::string name, const std::vector<Eigen::Vector2d>& corners_px) {
    Shape shape;
    shape.name = std::move(name);
    for (std::size_t i = 0; i < corners_px.size(); ++i) {
        const Eigen::Vector2d a = corners_px[i];
        const Eigen::Vector2d b = corners_px[(i + 1) % corners_px.size()];
        const int steps = std::max(1, static_cast<int>((b - a).norm() / 2));
        for (int k = 0; k < steps; ++k) {
            shape.points_px.push_back((a + (b - a) * k / steps).cast<float>());
        }
    }
    const auto count = static_cast<std::uint16_t>(shape.points_px.size());
    for (std::uint16_t i = 0; i < count; ++i) {
        shape.edges.push_back({i, static_cast<std::uint16_t>((i + 1) % count)});
    }
    return centred(shape);
}

/// A square of 40 px, a piece of contour each side.
inline Shape square() {
    Shape shape;
    shape.name = "square";
    shape.points_px = {{-20, -20}, {20, -20}, {20, 20}, {-20, 20}};
    shape.edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    return shape;
}

/// A circle of that many points, joined.
inline Shape ring(const std::string& name, double radius_px, int points) {
    Shape shape{name, {}, {}};
    for (int i = 0; i < points; ++i) {
        const double angle = 2 * std::numbers::pi * i / points;
        shape.points_px.push_back(
            (radius_px * Eigen::Vector2d(std::cos(angle), std::sin(angle))).cast<float>());
        shape.edges.push_back(
            {static_cast<std::uint16_t>(i), static_cast<std::uint16_t>((i + 1) % points)});
    }
    return shape;
}

/// No symmetry: every pose of it looks different.
inline Shape arrow(std::string name = "arrow") {
    return polygon(std::move(name),
                   {{-30, -6}, {8, -6}, {8, -18}, {32, 0}, {8, 14}, {8, 6}, {-30, 6}});
}

/// A tracker that follows an arrow with the filter, from this start, in a new stream.
inline Tracker that_follows_an_arrow(const Pose& start) {
    Tracker tracker = Tracker::create({}).value();
    tracker.begin_stream(small_sensor, 1);
    Registration registration;
    registration.shape = arrow();
    registration.estimator = EstimatorKind::kalman;
    registration.start.pose = start;
    tracker.register_object(registration).value();  // throws where it is refused
    return tracker;
}

/// Of that arrow at 500 px/s, fewer where it is slower: two events for each px² that its contour
/// covers.
constexpr double arrow_per_ms = 170;

/// Of so much noise a pixel of the small sensor.
constexpr double noise_per_ms(double hz) {
    return hz * small_sensor.width * small_sensor.height * 1e-3;
}

/// Events of an outline that moves: `per_ms` events a ms at places drawn evenly along the contour,
/// each at the rounded pixel of the true outline and with the polarity of the motion across it
/// (inside dark), and noise anywhere. A crude sensor, for tests that need an object's events alone;
/// `pose_at(t_us)` is the truth.
template <class PoseAt>
std::vector<Event> outline_events(const Shape& shape, PoseAt pose_at, std::int64_t from_us,
                                  std::int64_t to_us, double per_ms, double noise_per_ms,
                                  Geometry geometry, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
    std::vector<Event> events;
    const auto put = [&](double t_us, double x_px, double y_px, bool on) {
        const double x = std::round(x_px);
        const double y = std::round(y_px);
        if (x < 0 || y < 0 || x >= geometry.width || y >= geometry.height) return;
        events.push_back({static_cast<std::int64_t>(t_us), static_cast<std::uint16_t>(x),
                          static_cast<std::uint16_t>(y), static_cast<std::uint8_t>(on)});
    };
    const double span_ms = static_cast<double>(to_us - from_us) * 1e-3;
    for (int i = 0; i < static_cast<int>(span_ms * per_ms); ++i) {
        const double t_us = static_cast<double>(from_us) + uniform() * span_ms * 1e3;
        const Edge edge = shape.edges[random() % shape.edges.size()];
        const Eigen::Vector2d a = shape.points_px[edge.from].cast<double>();
        const Eigen::Vector2d b = shape.points_px[edge.to].cast<double>();
        const Eigen::Vector2d m = a + (b - a) * uniform();
        const Pose pose = pose_at(t_us);
        const Pose later = pose_at(t_us + 10);
        const Eigen::Vector2d p = pose.t_px + pose.a * m;
        const Eigen::Vector2d along = pose.a * (b - a);
        const Eigen::Vector2d outward = Eigen::Vector2d(along.y(), -along.x()).normalized();
        const double speed_px_us = outward.dot(later.t_px + later.a * m - p) / 10;
        // An edge that does not move across itself changes no pixel.
        if (uniform() * 5e-4 > std::abs(speed_px_us)) continue;
        put(t_us, p.x(), p.y(), speed_px_us < 0);
    }
    for (int i = 0; i < static_cast<int>(span_ms * noise_per_ms); ++i) {
        put(static_cast<double>(from_us) + uniform() * span_ms * 1e3, uniform() * geometry.width,
            uniform() * geometry.height, random() % 2 == 0);
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const Event& l, const Event& r) { return l.t_us < r.t_us; });
    return events;
}

/// rms distance between the shape's points under two poses, px.
inline double rms_px(const Shape& shape, const Pose& a, const Pose& b) {
    double sum = 0;
    for (const auto& point : shape.points_px) {
        const Eigen::Vector2d m = point.cast<double>();
        sum += (a.t_px + a.a * m - b.t_px - b.a * m).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(shape.points_px.size()));
}

}  // namespace pursuit::tracker::test
