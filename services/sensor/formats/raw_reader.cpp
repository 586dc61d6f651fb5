// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/raw_reader.hpp"

#include <string>
#include <utility>

#include "services/sensor/formats/evt21_reader.hpp"
#include "services/sensor/formats/evt2_reader.hpp"
#include "services/sensor/formats/evt3_reader.hpp"
#include "services/sensor/formats/raw_header.hpp"

namespace pursuit::sensor {
namespace {

constexpr Geometry gen3{640, 480};
constexpr Geometry gen4{1280, 720};

std::unique_ptr<EventReader> make_reader(ByteWindow bytes, const std::string& evt,
                                         const RawHeader& header, const ReadOptions& options) {
    RawSettings settings;
    const auto stated = options.geometry ? options.geometry : header.geometry;
    settings.geometry = stated.value_or(evt == "2.0" ? gen3 : gen4);
    settings.geometry_is_stated = stated.has_value();
    settings.joined_late = options.joined_late;
    if (evt == "2.0") return make_evt2_reader(std::move(bytes), settings);
    if (evt == "2.1") return make_evt21_reader(std::move(bytes), settings, header.halves_swapped);
    return make_evt3_reader(std::move(bytes), settings);
}

Result<std::unique_ptr<EventReader>> open_as(const std::string& evt, ByteWindow bytes,
                                             const ReadOptions& options) {
    const auto header = read_raw_header(bytes);
    if (!header) return tl::unexpected(header.error());
    if (header->evt && *header->evt != evt) {
        return tl::unexpected(
            error_at(bytes.name(), 0, "the header states evt " + *header->evt + ", not " + evt));
    }
    return make_reader(std::move(bytes), evt, *header, options);
}

}  // namespace

bool looks_like_raw(std::string_view head) {
    return head.substr(0, 1) == "%" && (head.find("% evt ") != std::string_view::npos ||
                                        head.find("% format EVT") != std::string_view::npos);
}

Result<std::unique_ptr<EventReader>> open_raw(ByteWindow bytes, const ReadOptions& options) {
    const auto header = read_raw_header(bytes);
    if (!header) return tl::unexpected(header.error());
    const auto fault = [&](const std::string& cause) {
        return tl::unexpected(error_at(bytes.name(), bytes.offset(), cause));
    };
    if (!header->evt) {
        return fault("the header ends without a line \"% evt\" or \"% format\": name the format");
    }
    if (*header->evt != "2.0" && *header->evt != "2.1" && *header->evt != "3.0") {
        return fault("the header states evt " + *header->evt + "; 2.0, 2.1 and 3.0 are read");
    }
    return make_reader(std::move(bytes), *header->evt, *header, options);
}

Result<std::unique_ptr<EventReader>> open_evt2(ByteWindow bytes, const ReadOptions& options) {
    return open_as("2.0", std::move(bytes), options);
}

Result<std::unique_ptr<EventReader>> open_evt21(ByteWindow bytes, const ReadOptions& options) {
    return open_as("2.1", std::move(bytes), options);
}

Result<std::unique_ptr<EventReader>> open_evt3(ByteWindow bytes, const ReadOptions& options) {
    return open_as("3.0", std::move(bytes), options);
}

}  // namespace pursuit::sensor
