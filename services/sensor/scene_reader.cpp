// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene_reader.hpp"

#include <algorithm>

namespace pursuit::sensor {
namespace {

constexpr std::int64_t slice_us = 1000;
constexpr std::int64_t longest_silence_us = 3'600'000'000;

}  // namespace

EventReader::Decoded SceneReader::decode(std::span<Event> events, std::span<Event> /*exposures*/) {
    if (taken_ == slice_.size()) {
        slice_.clear();
        taken_ = 0;
        const auto give_up_us = simulator_.time_us() + longest_silence_us;
        while (slice_.empty() && simulator_.time_us() < give_up_us) {
            if (!simulator_.next(slice_us, slice_)) break;
        }
    }
    const auto count = std::min(events.size(), slice_.size() - taken_);
    std::copy_n(slice_.begin() + static_cast<std::ptrdiff_t>(taken_), count, events.begin());
    taken_ += count;
    Decoded done;
    done.count = count;
    return done;
}

Result<std::unique_ptr<EventReader>> open_scene(const std::string& scene, std::uint64_t seed) {
    auto loaded = load_scene(scene);
    if (!loaded) return tl::unexpected(loaded.error());
    return std::make_unique<SceneReader>(*loaded, seed);
}

}  // namespace pursuit::sensor
