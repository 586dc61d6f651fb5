// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/source.hpp"

#include <utility>

#include "services/sensor/formats/formats.hpp"
#include "services/sensor/range_reader.hpp"
#include "services/sensor/scene_reader.hpp"

namespace pursuit::sensor {
Result<std::unique_ptr<EventReader>> open_source(const disk::SensorConfig& config) {
    if (config.recording().empty() == config.scene().empty()) {
        return fail("exactly one of recording and scene must be named");
    }
    const auto range = range_of_seconds(config.start_s(), config.end_s());
    if (!range) return fail("start_s, end_s: " + range.error().message);
    auto source = config.scene().empty() ? open_events(config.recording())
                                         : open_scene(config.scene(), config.seed());
    if (!source) return source;
    return in_range(std::move(*source), *range);
}

}  // namespace pursuit::sensor
