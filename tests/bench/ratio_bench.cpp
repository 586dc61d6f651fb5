// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/ratio_bench.hpp"

#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/outline_scene.hpp"
#include "tests/bench/scalar_paper.hpp"

namespace pursuit::tracker::bench {
namespace {

/// Of this thread on the processor: what other programs take is not counted.
double now_ns() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// What the disc makes at 670 rpm: what is done every few ms weighs less on each event.
constexpr double fast_hz = 500'000;

/// One of those that take turns.
struct Contender {
    std::string name;
    std::vector<Event> events;
    std::function<void(std::span<const Event>)> process;
    std::vector<double> ns_an_event = {};

    void turn(bool counts) {
        const double begin_ns = now_ns();
        process(events);
        const double taken_ns = now_ns() - begin_ns;
        if (counts) ns_an_event.push_back(taken_ns / static_cast<double>(events.size()));
        next_period(events);
    }
};

Contender contender(std::string name, const Case& of, std::vector<Event> events) {
    auto tracker = std::make_shared<Tracker>(std::move(*tracker_of(of)));
    auto poses = std::make_shared<test::Poses>();
    return {std::move(name), std::move(events), [tracker, poses](std::span<const Event> some) {
                tracker->process(some, *poses);
                poses->rows.clear();
            }};
}

/// Takes turns; gives the median cost of each as a counter, ns an event.
std::vector<double> compete(benchmark::State& state, std::vector<Contender> contenders) {
    // What is learnt in the first moments is not what is measured.
    for (int i = 0; i < 2; ++i) {
        for (Contender& each : contenders) each.turn(false);
    }
    for (auto unused : state) {
        for (Contender& each : contenders) each.turn(true);
    }
    std::vector<double> medians;
    for (const Contender& each : contenders) {
        medians.push_back(median(each.ns_an_event));
        state.counters[each.name + "_ns"] = medians.back();
    }
    return medians;
}

void beside_the_scalar_reading(benchmark::State& state, int points, double rate_hz) {
    Case of;
    of.points = points;
    of.rate_hz = rate_hz;
    const auto events = events_on_contours(of);
    auto paper = std::make_shared<ScalarPaper>(outline("o", points), pose_at(0, false, 0),
                                               ObjectParameters());
    std::vector<Contender> all;
    all.push_back({"scalar", events, [paper](std::span<const Event> some) {
                       benchmark::DoNotOptimize(paper->process(some));
                   }});
    of.estimator = EstimatorKind::gradient;
    all.push_back(contender("gradient", of, events));
    of.estimator = EstimatorKind::kalman;
    all.push_back(contender("kalman", of, events));
    of.transform = TransformKind::full_affine;
    all.push_back(contender("affine", of, events));
    const auto ns = compete(state, std::move(all));
    state.counters["scalar/gradient"] = ns[0] / ns[1];
    state.counters["scalar/kalman"] = ns[0] / ns[2];
    // Where the plain reading would have lost the object, it was not the same work.
    const Pose end = paper->pose();
    if ((end.t_px - pose_at(0, false, 0).t_px).norm() > 1) {
        state.SkipWithError("the scalar reading lost the object");
    }
}

void many_beside_one(benchmark::State& state, int objects, EstimatorKind estimator, Place place,
                     double rate_hz) {
    Case one;
    one.estimator = estimator;
    one.rate_hz = rate_hz;
    Case many = one;
    many.objects = objects;
    std::vector<Contender> all;
    all.push_back(contender("one", one, events_at(one, place)));
    all.push_back(contender("many", many, events_at(many, place)));
    const auto ns = compete(state, std::move(all));
    state.counters["many/one"] = ns[1] / ns[0];
}

}  // namespace

void add_ratios() {
    for (const double rate_hz : {Case().rate_hz, fast_hz}) {
        for (const int points : {90, 500, 2000}) {
            const std::string name = "ratio/scalar/points:" + std::to_string(points) +
                                     "/rate_khz:" + std::to_string(std::lround(rate_hz * 1e-3));
            benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
                beside_the_scalar_reading(state, points, rate_hz);
            })->Unit(benchmark::kMillisecond);
        }
    }
    struct Events {
        Place place;
        double rate_hz;
        std::string name;
    };
    const Events used{Place::on_contours, rate_of_many_hz, "used"};
    const Events rejected{Place::elsewhere, off_contours_hz, "rejected"};
    const Events fast_rejected{Place::elsewhere, fast_off_contours_hz, "rejected, fast"};
    for (const EstimatorKind estimator : {EstimatorKind::gradient, EstimatorKind::kalman}) {
        for (const Events& events : {used, rejected, fast_rejected}) {
            for (const int objects : {10, 100}) {
                const std::string name = "ratio/objects:" + std::to_string(objects) + "/" +
                                         std::string(to_string(estimator)) + "/" + events.name;
                benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
                    many_beside_one(state, objects, estimator, events.place, events.rate_hz);
                })->Unit(benchmark::kMillisecond);
            }
        }
    }
}

}  // namespace pursuit::tracker::bench
