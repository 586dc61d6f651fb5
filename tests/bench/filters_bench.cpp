// SPDX-License-Identifier: Apache-2.0
// What each filter costs an event, one thread: 1280x720 pixels, half of the events noise all over
// the image, half on an edge that moves through it.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "services/sensor/filters/filter_chain.hpp"

namespace {

using pursuit::Event;
using pursuit::Geometry;
using pursuit::sensor::FilterChain;
using pursuit::sensor::FilterCounts;
using pursuit::sensor::FilterSetting;

constexpr Geometry geometry{1280, 720};
constexpr std::size_t block_events = 2048;

std::vector<Event> some_events() {
    std::mt19937 random(1);
    std::vector<Event> events(1 << 20);
    for (std::size_t i = 0; i < events.size(); ++i) {
        const bool edge = random() % 2 == 0;
        const auto x = edge ? i / 1024 + random() % 3 : random() % geometry.width;
        events[i] = {static_cast<std::int64_t>(i / 10), static_cast<std::uint16_t>(x),
                     static_cast<std::uint16_t>(random() % geometry.height),
                     static_cast<std::uint8_t>(random() % 2)};
    }
    return events;
}

void run(benchmark::State& state, const std::vector<FilterSetting>& settings) {
    static const auto events = some_events();
    auto chain = FilterChain::make(settings, geometry);
    if (!chain) {
        state.SkipWithError(chain.error().message.c_str());
        return;
    }
    std::vector<Event> block(block_events);
    FilterCounts counts{};
    std::int64_t passes = 0;
    std::int64_t later_us = 0;
    for (auto _ : state) {
        for (std::size_t i = 0; i < events.size(); i += block_events) {
            for (std::size_t j = 0; j < block_events; ++j) {
                block[j] = events[i + j];
                block[j].t_us += later_us;
            }
            benchmark::DoNotOptimize((*chain)->apply(block, counts));
        }
        later_us += events.back().t_us + 1;
        ++passes;
    }
    const auto done = passes * static_cast<std::int64_t>(events.size());
    state.SetItemsProcessed(done);
    // Shown as a time with its unit, of each event.
    state.counters["per_event"] = benchmark::Counter(
        static_cast<double>(done), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}  // namespace

int main(int argc, char** argv) {
    const auto folder = std::filesystem::temp_directory_path();
    const auto mask = (folder / "pursuit_benchmark_mask.textproto").string();
    const auto lens = (folder / "pursuit_benchmark_lens.textproto").string();
    std::ofstream(mask) << "width: 1280 height: 720 pixel { x_px: 600 y_px: 300 }\n"
                           "rectangle { x_px: 0 y_px: 0 width_px: 200 height_px: 720 }\n";
    std::ofstream(lens) << "width: 1280 height: 720 fx_px: 900 fy_px: 900 cx_px: 640 cy_px: 360\n"
                           "k1: -0.2 k2: 0.05\n";
    benchmark::RegisterBenchmark("none: the copy of the events alone",
                                 [](auto& state) { run(state, {}); });
    for (const std::string text :
         {"region_of_interest x_px=100 width_px=900", "pixel_mask", "hot_pixel", "refractory",
          "refractory by_polarity=1", "background_activity",
          "background_activity radius_px=2 support=2", "background_activity radius_px=3 support=3",
          "polarity keep=1", "geometry flip_x=1", "geometry rotate_deg=90",
          "rate_control max_rate_hz=5e6", "undistort"}) {
        auto setting = *pursuit::sensor::parse_filter(text);
        if (setting.filter == "pixel_mask") setting.file = mask;
        if (setting.filter == "undistort") setting.file = lens;
        benchmark::RegisterBenchmark(text.c_str(),
                                     [setting](auto& state) { run(state, {setting}); });
    }
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    std::filesystem::remove(mask);
    std::filesystem::remove(lens);
}
