// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker::bench {

constexpr Geometry geometry{1280, 720};

/// After it every object is where it was, and the same events may come again, that much later.
constexpr std::int64_t period_us = 250'000;

/// What a run is of; the defaults are what the others are varied from.
struct Case {
    int points = 120;
    int objects = 1;
    EstimatorKind estimator = EstimatorKind::kalman;
    StrategyKind strategy = StrategyKind::closest;
    TransformKind transform = TransformKind::isometry;
    bool is_ambiguous = false;  ///< Every object has another 2 px beside it.
    /// Events a second: on the contour of each object, or off contours in all. What is done every
    /// few ms, whatever the events, weighs on each of them the more the fewer they are.
    double rate_hz = 50'000;
};

/// Noise comes from the whole image.
constexpr double off_contours_hz = 400'000;

/// As much of it as four fifths of all events are, where a hundred objects make the rest.
constexpr double fast_off_contours_hz = 4'000'000;

/// On each of up to a hundred objects, so that they all fit one sensor.
constexpr double rate_of_many_hz = 10'000;

/// Where events lie.
enum class Place {
    on_contours,  ///< An object takes them.
    inside,       ///< Within an object's extent, and beyond the gate of its contour.
    elsewhere,    ///< Near no object.
};

/// A closed outline without symmetry, about 55 px across.
inline Shape outline(const std::string& name, int points) {
    Shape shape{name, {}, {}};
    for (int i = 0; i < points; ++i) {
        const double angle = 2 * std::numbers::pi * i / points;
        const double radius = 22 + 4 * std::cos(3 * angle) + 2 * std::sin(2 * angle);
        shape.points_px.push_back(
            (radius * Eigen::Vector2d(std::cos(angle), std::sin(angle))).cast<float>());
        shape.edges.push_back(
            {static_cast<std::uint16_t>(i), static_cast<std::uint16_t>((i + 1) % points)});
    }
    return centred(shape);
}

/// The place of an object, on a circle at 100 px/s that closes in one period.
inline Pose pose_at(int object, bool is_ambiguous, double t_us) {
    const int place = is_ambiguous ? object / 2 : object;
    const double aside_px = is_ambiguous && object % 2 == 1 ? 2 : 0;
    const double phase = 2 * std::numbers::pi * t_us / static_cast<double>(period_us);
    return pose_of(64 + 128 * (place % 10) + aside_px + 4 * std::cos(phase),
                   36 + 72 * (place / 10) + 4 * std::sin(phase), 0.02 * std::sin(phase));
}

inline std::vector<Event> events_on_contours(const Case& of) {
    const Shape shape = outline("o", of.points);
    std::vector<Event> events;
    // An edge makes events as it moves across itself: of those drawn, about one in eight.
    const double per_ms = of.rate_hz * 1e-3 * 7.9;
    for (int k = 0; k < of.objects; ++k) {
        const auto more = test::outline_events(
            shape, [&](double t_us) { return pose_at(k, of.is_ambiguous, t_us); }, 0, period_us,
            per_ms, 0, geometry, static_cast<std::uint32_t>(k));
        events.insert(events.end(), more.begin(), more.end());
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const Event& l, const Event& r) { return l.t_us < r.t_us; });
    return events;
}

/// Drawn evenly over the places asked for. Nothing moves the objects: they stay at their starts.
inline std::vector<Event> events_off_contours(const Case& of, Place place) {
    // The contour lies 16 to 28 px from the centre; the gate is 4 px.
    constexpr int inner_px = 8;
    constexpr double outer_px = 42;
    std::vector<Eigen::Vector2d> centres_px;
    for (int k = 0; k < of.objects; ++k) {
        centres_px.push_back(pose_at(k, of.is_ambiguous, 0).t_px);
    }
    std::mt19937 random(1);
    const auto below = [&](int count) { return static_cast<int>(random() % count); };
    const auto pixel = [&]() -> Eigen::Vector2d {
        if (place == Place::elsewhere) return {below(geometry.width), below(geometry.height)};
        const Eigen::Vector2d aside{below(2 * inner_px + 1), below(2 * inner_px + 1)};
        return centres_px[below(of.objects)] + aside - Eigen::Vector2d(inner_px, inner_px);
    };
    std::vector<Event> events;
    const double step_us = 1e6 / of.rate_hz;
    for (double t_us = 0; t_us < static_cast<double>(period_us);) {
        const Eigen::Vector2d at = pixel();
        double nearest_px = 1e9;
        for (const auto& centre : centres_px) {
            nearest_px = std::min(nearest_px, (at - centre).norm());
        }
        if (place == Place::inside ? nearest_px > inner_px : nearest_px < outer_px) continue;
        events.push_back({static_cast<std::int64_t>(t_us), static_cast<std::uint16_t>(at.x()),
                          static_cast<std::uint16_t>(at.y()), 1});
        t_us += step_us;
    }
    return events;
}

inline std::vector<Event> events_at(const Case& of, Place place) {
    return place == Place::on_contours ? events_on_contours(of) : events_off_contours(of, place);
}

/// A tracker that follows the objects of a case from the beginning of a period; an error says what
/// was refused.
inline CallResult<Tracker> tracker_of(const Case& of) {
    TrackerOptions options;
    options.pose_rate_hz = 1;
    auto tracker = Tracker::create(options);
    if (!tracker) return tracker;
    tracker->begin_stream(geometry, 1);
    if (auto set = tracker->set_strategy(of.strategy, {}); !set) {
        return tl::unexpected(set.error());
    }
    for (int k = 0; k < of.objects; ++k) {
        Registration registration;
        registration.shape = outline("o" + std::to_string(k), of.points);
        registration.transform = of.transform;
        registration.estimator = of.estimator;
        registration.start.pose = pose_at(k, of.is_ambiguous, 0);
        const auto registered = tracker->register_object(registration);
        if (!registered) return tl::unexpected(registered.error());
    }
    return tracker;
}

inline void next_period(std::vector<Event>& events) {
    for (Event& event : events) event.t_us += period_us;
}

}  // namespace pursuit::tracker::bench
