// SPDX-License-Identifier: Apache-2.0
// What an event costs the tracker core: ns an event, apart for events that move an object, for
// those inside of one that its contour refuses, and for those near no object. One thing varies at a
// time. The ratios (ratio_bench.cpp) are measured in turns in the same run.
//
//     build/release/bench/tracker_bench [--benchmark_filter=used|inside|rejected|ratio]
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/bench/allocation_count.hpp"
#include "tests/bench/outline_scene.hpp"
#include "tests/bench/ratio_bench.hpp"

namespace pursuit::tracker::bench {
namespace {

using Events = std::vector<Event>;

void run(benchmark::State& state, const Case& of, Events events) {
    auto tracker = tracker_of(of);
    if (!tracker) return state.SkipWithError(tracker.error().message.c_str());
    test::Poses poses;
    // What is learnt in the first moments is not what is measured.
    for (int i = 0; i < 2; ++i) {
        tracker->process(events, poses);
        next_period(events);
    }
    const TrackerCounters before = tracker->counters();
    const auto allocated_before = allocations();
    for (auto unused : state) {
        tracker->process(events, poses);
        state.PauseTiming();
        next_period(events);
        poses.rows.clear();
        state.ResumeTiming();
    }
    const auto allocated = allocations() - allocated_before;
    const TrackerCounters& after = tracker->counters();
    const auto count = static_cast<double>(after.events_in - before.events_in);
    state.counters["used"] = static_cast<double>(after.events_used - before.events_used) / count;
    state.counters["allocations"] = static_cast<double>(allocated) / count;
    state.counters["per_event"] =
        benchmark::Counter(count, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void add(const std::string& name, const Case& of, Place place) {
    // Made once: a benchmark is begun several times, each with a new tracker.
    const auto events = std::make_shared<Events>();
    const auto run_it = [=](benchmark::State& state) {
        if (events->empty()) *events = events_at(of, place);
        run(state, of, *events);
    };
    benchmark::RegisterBenchmark(name.c_str(), run_it)->Unit(benchmark::kMillisecond);
}

void add(const std::string& name, Case of) {
    add("used/" + name, of, Place::on_contours);
    of.rate_hz = off_contours_hz;
    if (of.objects == 1) add("inside/" + name, of, Place::inside);
    add("rejected/" + name, of, Place::elsewhere);
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
        of.rate_hz = rate_of_many_hz;
        for (const int objects : {1, 2, 10, 100}) {
            of.objects = objects;
            add(name + "/objects:" + std::to_string(objects), of);
        }
        of.objects = 1;
        for (const int rate_khz : {5, 50, 500}) {
            of.rate_hz = 1e3 * rate_khz;
            add("used/" + name + "/rate_khz:" + std::to_string(rate_khz), of, Place::on_contours);
        }
        for (const int rate_khz : {40, 400, 4000}) {
            of.rate_hz = 1e3 * rate_khz;
            add("rejected/" + name + "/rate_khz:" + std::to_string(rate_khz), of, Place::elsewhere);
        }
        of.rate_hz = Case().rate_hz;
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
}  // namespace pursuit::tracker::bench

int main(int argc, char** argv) {
    pursuit::tracker::bench::add_ratios();
    pursuit::tracker::bench::add_all();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
