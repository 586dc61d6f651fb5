// SPDX-License-Identifier: Apache-2.0
// How many events a second each decoder makes of bytes in memory, on one thread, and how that
// compares with memcpy of the same bytes in the same run.
//
//   formats_bench [FOLDER OF RECORDINGS]     (default: PURSUIT_TEST_DATA, else ../shared/data)
#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "services/sensor/formats/formats.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t events_at_a_time = 8192;

std::string content_of(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Decodes everything once; returns the number of events and measurements, 0 where it fails.
std::uint64_t decode(const std::string& name, const std::string& bytes, std::vector<Event>& events,
                     std::vector<Event>& exposures) {
    auto reader = open_events(
        from_memory(name, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
    if (!reader) return 0;
    for (;;) {
        const auto batch = (*reader)->read(events, exposures);
        if (!batch) return 0;
        benchmark::DoNotOptimize(events.data());
        if (batch->at_end) return (*reader)->events_read() + (*reader)->exposures_read();
    }
}

/// Of this thread on the processor: what other programs take is not counted.
double now_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_of_memcpy(const std::string& bytes, std::vector<char>& to) {
    const auto begin_s = now_s();
    std::memcpy(to.data(), bytes.data(), bytes.size());
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
    return now_s() - begin_s;
}

/// Decoding and memcpy take turns, so that what disturbs one disturbs the other.
void measure(benchmark::State& state, const std::string& path) {
    const auto bytes = content_of(path);
    std::vector<Event> events(events_at_a_time);
    std::vector<Event> exposures(events_at_a_time);
    std::vector<char> copy(bytes.size());
    const auto count = decode(path, bytes, events, exposures);
    if (count == 0) {
        state.SkipWithError("cannot be decoded");
        return;
    }
    std::vector<double> copies_s;
    std::vector<double> decodes_s;
    for (auto _ : state) {
        copies_s.push_back(seconds_of_memcpy(bytes, copy));
        const auto begin_s = now_s();
        decode(path, bytes, events, exposures);
        decodes_s.push_back(now_s() - begin_s);
        state.SetIterationTime(decodes_s.back());
    }
    const auto median = [](std::vector<double>& values) {
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        return *middle;
    };
    const double decode_s = median(decodes_s);
    state.counters["Mevents_per_s"] = static_cast<double>(count) / decode_s * 1e-6;
    state.counters["GB_per_s"] = static_cast<double>(bytes.size()) / decode_s * 1e-9;
    state.counters["times_memcpy"] = decode_s / median(copies_s);
}

}  // namespace
}  // namespace pursuit::sensor

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    const char* variable = std::getenv("PURSUIT_TEST_DATA");
    const std::string folder = argc > 1              ? argv[1]
                               : variable != nullptr ? variable
                                                     : "../shared/data";
    for (const std::string name :
         {"car/car_atis_td.dat", "decoders/rendered_plane.es", "car/car_atis_td_em.es",
          "decoders/evt2_sample.raw", "decoders/evt3_sample.raw", "decoders/evt3_triggers.raw",
          "decoders/nmnist_digit.bin", "decoders/foam90.aedat", "decoders/davis.aedat4",
          "shapes_rotation/events.txt"}) {
        const auto path = folder + "/" + name;
        benchmark::RegisterBenchmark(name.c_str(), [path](benchmark::State& state) {
            pursuit::sensor::measure(state, path);
        })->UseManualTime();
    }
    benchmark::RunSpecifiedBenchmarks();
}
