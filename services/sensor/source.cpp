// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/source.hpp"

#include <cmath>
#include <utility>

#include "services/sensor/formats/formats.hpp"
#include "services/sensor/range_reader.hpp"
#include "services/sensor/scene_reader.hpp"

namespace pursuit::sensor {
namespace {

constexpr double longest_s = 9e12;  // as us within 63 bits

Result<TimeRange> range_of(const disk::SensorConfig& config) {
    if (config.start_s() > longest_s || config.end_s() > longest_s) {
        return fail("start_s and end_s must be at most 9e12");
    }
    const TimeRange range{std::llround(config.start_s() * 1e6), std::llround(config.end_s() * 1e6)};
    if (range.end_us != 0 && range.end_us <= range.start_us) {
        return fail("end_s must be after start_s, or 0 for the source's end");
    }
    return range;
}

}  // namespace

Result<std::unique_ptr<EventReader>> open_source(const disk::SensorConfig& config) {
    if (config.recording().empty() == config.scene().empty()) {
        return fail("exactly one of recording and scene must be named");
    }
    const auto range = range_of(config);
    if (!range) return tl::unexpected(range.error());
    auto source = config.scene().empty() ? open_events(config.recording())
                                         : open_scene(config.scene(), config.seed());
    if (!source) return source;
    return in_range(std::move(*source), *range);
}

}  // namespace pursuit::sensor
