// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene_reader.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::int64_t slice_us = 1000;
constexpr std::int64_t most_silence_a_call_us = 100'000;
constexpr std::int64_t longest_silence_us = 3'600'000'000;

}  // namespace

void SceneReader::Slice::clear() {
    events.clear();
    taken = 0;
}

EventReader::Decoded SceneReader::decode(std::span<Event> events, std::span<Event> exposures) {
    Decoded done;
    const auto begin_us = simulator_.time_us();
    const auto give_up_us = silent_since_us_ + longest_silence_us;
    while (events_.empty() && exposures_.empty() && simulator_.time_us() < give_up_us) {
        if (simulator_.time_us() - begin_us >= most_silence_a_call_us) {
            done.goes_on = true;
            return done;
        }
        events_.clear();
        exposures_.clear();
        if (!simulator_.next(slice_us, events_.events,
                             exposures.empty() ? nullptr : &exposures_.events)) {
            break;
        }
    }
    // In order of time over both, until one of the spans is full.
    silent_since_us_ = simulator_.time_us();
    if (exposures.empty()) exposures_.clear();
    while (!events_.empty() || !exposures_.empty()) {
        const bool event_next =
            exposures_.empty() ||
            (!events_.empty() && events_.front().t_us <= exposures_.front().t_us);
        if (event_next) {
            if (done.count == events.size()) break;
            events[done.count++] = events_.front();
            ++events_.taken;
        } else {
            if (done.exposures == exposures.size()) break;
            exposures[done.exposures++] = exposures_.front();
            ++exposures_.taken;
        }
    }
    return done;
}

Result<std::unique_ptr<EventReader>> open_scene(const std::string& scene, std::uint64_t seed) {
    auto loaded = load_scene(scene);
    if (!loaded) return tl::unexpected(loaded.error());
    return std::make_unique<SceneReader>(*loaded, seed);
}

}  // namespace pursuit::sensor
