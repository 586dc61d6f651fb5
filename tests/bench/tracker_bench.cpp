// SPDX-License-Identifier: Apache-2.0
// What an event costs the tracker core: ns an event, apart for events that move an object and for
// those that no object takes. One thing varies at a time.
//
//     build/release/bench/tracker_bench [--benchmark_filter=used]
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

constexpr Geometry geometry{1280, 720};
constexpr std::int64_t period_us = 250'000;

/// What a run is of; the defaults are what the others are varied from.
struct Case {
    int points = 120;
    int objects = 1;
    EstimatorKind estimator = EstimatorKind::kalman;
    StrategyKind strategy = StrategyKind::closest;
    TransformKind transform = TransformKind::isometry;
    bool is_ambiguous = false;  // Every object has another 2 px beside it.
};

/// A closed outline without symmetry, about 55 px across.
Shape outline(const std::string& name, int points) {
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
Pose pose_at(int object, bool is_ambiguous, double t_us) {
    const int place = is_ambiguous ? object / 2 : object;
    const double aside_px = is_ambiguous && object % 2 == 1 ? 2 : 0;
    const double phase = 2 * std::numbers::pi * t_us / static_cast<double>(period_us);
    return pose_of(64 + 128 * (place % 10) + aside_px + 4 * std::cos(phase),
                   36 + 72 * (place / 10) + 4 * std::sin(phase), 0.02 * std::sin(phase));
}

std::vector<Event> events_on(const Case& of, const Shape& shape) {
    std::vector<Event> events;
    const double per_ms = of.objects > 10 ? 4 : 40;
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

std::vector<Event> events_elsewhere(const Case& of) {
    std::vector<Event> events;
    std::mt19937 random(1);
    while (events.size() < 10'000) {
        const Event event{static_cast<std::int64_t>(events.size() * 25),
                          static_cast<std::uint16_t>(random() % geometry.width),
                          static_cast<std::uint16_t>(random() % geometry.height), 1};
        bool is_clear = true;
        for (int k = 0; k < of.objects; ++k) {
            const Pose pose = pose_at(k, of.is_ambiguous, 0);
            is_clear &= (Eigen::Vector2d(event.x, event.y) - pose.t_px).norm() > 42;
        }
        if (is_clear) events.push_back(event);
    }
    return events;
}

void run(benchmark::State& state, const Case& of, bool is_used) {
    TrackerOptions options;
    options.pose_rate_hz = 1;
    Tracker tracker = std::move(*Tracker::create(options));
    tracker.begin_stream(geometry, 1);
    if (!tracker.set_strategy(of.strategy, {})) return state.SkipWithError("strategy refused");
    for (int k = 0; k < of.objects; ++k) {
        Registration registration;
        registration.shape = outline("o" + std::to_string(k), of.points);
        registration.transform = of.transform;
        registration.estimator = of.estimator;
        registration.start.pose = pose_at(k, of.is_ambiguous, 0);
        if (!tracker.register_object(registration)) return state.SkipWithError("model refused");
    }
    auto events = is_used ? events_on(of, outline("o", of.points)) : events_elsewhere(of);
    const auto next_period = [&] {
        for (Event& event : events) event.t_us += period_us;
    };
    test::Poses poses;
    // What is learnt in the first moments is not what is measured.
    for (int i = 0; i < 4; ++i) {
        tracker.process(events, poses);
        next_period();
    }
    const TrackerCounters before = tracker.counters();
    for (auto unused : state) {
        tracker.process(events, poses);
        state.PauseTiming();
        next_period();
        poses.rows.clear();
        state.ResumeTiming();
    }
    const TrackerCounters& after = tracker.counters();
    const auto count = static_cast<double>(after.events_in - before.events_in);
    state.counters["used"] = static_cast<double>(after.events_used - before.events_used) / count;
    state.counters["per_event"] =
        benchmark::Counter(count, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void add(const std::string& name, const Case& of) {
    for (const bool is_used : {true, false}) {
        benchmark::RegisterBenchmark(((is_used ? "used/" : "rejected/") + name).c_str(),
                                     [of, is_used](benchmark::State& s) { run(s, of, is_used); })
            ->Unit(benchmark::kMillisecond);
    }
}

void add_all() {
    for (const EstimatorKind estimator : {EstimatorKind::gradient, EstimatorKind::kalman}) {
        Case of;
        of.estimator = estimator;
        const std::string name(to_string(estimator));
        for (const int points : {60, 120, 500, 2000, 4096}) {
            of.points = points;
            add(name + "/points:" + std::to_string(points), of);
        }
        of.points = Case().points;
        for (const int objects : {2, 10, 100}) {
            of.objects = objects;
            add(name + "/objects:" + std::to_string(objects), of);
        }
        of.objects = 1;
        for (const auto transform :
             {TransformKind::similarity, TransformKind::paper_affine, TransformKind::full_affine}) {
            of.transform = transform;
            add(name + "/" + std::string(to_string(transform)), of);
        }
        of.transform = TransformKind::isometry;
        of.objects = 2;
        of.is_ambiguous = true;
        for (int kind = 0; kind <= static_cast<int>(StrategyKind::probabilistic); ++kind) {
            of.strategy = static_cast<StrategyKind>(kind);
            add(name + "/" + std::string(to_string(of.strategy)), of);
        }
    }
}

}  // namespace
}  // namespace pursuit::tracker

int main(int argc, char** argv) {
    pursuit::tracker::add_all();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
