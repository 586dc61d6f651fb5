// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/source.hpp"

#include <filesystem>
#include <optional>
#include <utility>

#include "services/common/geometry_text.hpp"
#include "services/sensor/live/byte_stream_input.hpp"
#include "services/sensor/live/driver_input.hpp"
#include "services/sensor/range_reader.hpp"
#include "services/sensor/scene_reader.hpp"

namespace pursuit::sensor {
namespace {

/// "640x480"; empty text: none.
Result<std::optional<Geometry>> geometry_of(const std::string& text) {
    if (text.empty()) return std::optional<Geometry>{};
    const auto geometry = parse_geometry(text);
    if (!geometry) {
        return fail_field("live_geometry", " is \"" + text + "\", must be WxH, as 640x480");
    }
    return geometry;
}

}  // namespace

std::string source_name(const disk::SensorConfig& config) {
    if (!config.live().empty()) return config.live() == "-" ? "standard input" : config.live();
    if (!config.driver().empty()) return "driver " + config.driver();
    return config.has_scene() ? "scene " + config.scene() : config.recording();
}

Result<bool> is_live(const disk::SensorConfig& config) {
    const int named = (config.recording().empty() ? 0 : 1) + (config.scene().empty() ? 0 : 1) +
                      (config.live().empty() ? 0 : 1) + (config.driver().empty() ? 0 : 1);
    if (named != 1) return fail("exactly one of recording, scene, live and driver must be named");
    const bool live = !config.live().empty() || !config.driver().empty();
    const char* of_others = config.loop()           ? "loop"
                            : config.start_s() != 0 ? "start_s"
                            : config.end_s() != 0   ? "end_s"
                                                    : nullptr;
    if (live && of_others != nullptr) {
        return fail_field(of_others, " goes with a recording or a scene, not with a live source");
    }
    return live;
}

Result<ReadOptions> live_options(const disk::SensorConfig& config) {
    const auto geometry = geometry_of(config.live_geometry());
    if (!geometry) return tl::unexpected(geometry.error());
    std::string names;
    for (const auto& format : formats()) {
        if (format.name == config.live_format()) {
            return ReadOptions{config.live_format(), *geometry, true};
        }
        names += (names.empty() ? "" : ", ") + std::string(format.name);
    }
    return fail_field("live_format",
                      " is \"" + config.live_format() + "\", must be one of " + names);
}

Result<std::unique_ptr<LiveInput>> open_live(const disk::SensorConfig& config) {
    const std::chrono::milliseconds longest_wait(config.reconnect_ms());
    if (!config.driver().empty()) {
        auto driver = DriverInput::load(config.driver(), config.driver_argument(), longest_wait);
        if (!driver) return tl::unexpected(driver.error());
        return std::move(*driver);
    }
    auto address = parse_live_address(config.live());
    if (!address) return fail_field("live", ": " + address.error().message);
    auto options = live_options(config);
    if (!options) return tl::unexpected(options.error());
    return std::make_unique<ByteStreamInput>(std::move(*address), std::move(*options),
                                             longest_wait);
}

Result<std::unique_ptr<EventReader>> open_source(const disk::SensorConfig& config) {
    const auto live = is_live(config);
    if (!live) return tl::unexpected(live.error());
    if (*live) return fail("a live source cannot be read as a recording");
    const auto range = range_of_seconds(config.start_s(), config.end_s());
    if (!range) {
        return tl::unexpected<Error>(Error{"fields start_s, end_s: " + range.error().message,
                                           config.end_s() != 0 ? "end_s" : "start_s"});
    }
    std::error_code not_there;  // then opening it says so
    const std::filesystem::path recording(config.recording());
    if (std::filesystem::exists(recording, not_there) &&
        !std::filesystem::is_regular_file(recording, not_there) &&
        !std::filesystem::is_directory(recording, not_there)) {
        return fail_field("recording", ": " + config.recording() +
                                           " is not a regular file; a FIFO or a device is heard "
                                           "with live");
    }
    const bool is_scene = !config.scene().empty();
    auto source =
        is_scene ? open_scene(config.scene(), config.seed()) : open_events(config.recording());
    if (!source) {
        return fail_field(is_scene ? "scene" : "recording", ": " + source.error().message);
    }
    return in_range(std::move(*source), *range);
}

}  // namespace pursuit::sensor
