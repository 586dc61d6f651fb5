// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/raw_header.hpp"

#include <algorithm>
#include <string_view>

#include "services/sensor/formats/event_reader.hpp"
#include "services/sensor/formats/text_line.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t raw_longest_line = 4096;
constexpr int raw_most_lines = 1000;
constexpr int raw_largest_side = 1 << 11;  // an event has 11 bits for x and for y

/// A side of the pixel array, 0 where the text is none.
std::uint16_t side(std::string_view text) {
    int number = 0;
    const bool good = parse(text, number) && number >= 1 && number <= raw_largest_side;
    return good ? static_cast<std::uint16_t>(number) : std::uint16_t{0};
}

Result<void> set_geometry(RawHeader& header, std::string_view width, std::string_view height) {
    const Geometry geometry{side(width), side(height)};
    if (geometry.width == 0 || geometry.height == 0) {
        return fail("\"" + std::string(width) + "\" x \"" + std::string(height) +
                    "\" is not a size of 1 to 2048 pixels a side");
    }
    header.geometry = geometry;
    return {};
}

/// "EVT21;endianness=legacy;height=720;width=1280"
Result<void> read_format(RawHeader& header, std::string_view text) {
    const auto name = take_until(text, ';');
    if (name.substr(0, 3) == "EVT" && name.size() > 3) {
        header.evt = std::string(name.substr(3, 1)) + "." +
                     std::string(name.size() > 4 ? name.substr(4) : "0");
    } else {
        header.evt = std::string(name);
    }
    std::string_view width;
    std::string_view height;
    while (!text.empty()) {
        auto value = take_until(text, ';');
        const auto key = take_until(value, '=');
        if (key == "width") width = value;
        if (key == "height") height = value;
        if (key == "endianness") header.halves_swapped = value == "legacy";
    }
    return width.empty() && height.empty() ? Result<void>{} : set_geometry(header, width, height);
}

Result<void> read_line(RawHeader& header, std::string_view line) {
    const auto key = take_until(line, ' ');
    if (key == "evt") header.evt = std::string(line);
    if (key == "format") return read_format(header, line);
    if (key == "geometry") {
        const auto width = take_until(line, 'x');
        return set_geometry(header, width, line);
    }
    return {};
}

}  // namespace

Result<RawHeader> read_raw_header(ByteWindow& bytes) {
    RawHeader header;
    for (int lines = 0;; ++lines) {
        const auto first = bytes.ahead(1);
        if (!first) return tl::unexpected(first.error());
        if (first->empty() || first->front() != '%') return header;
        const auto line = bytes.line(raw_longest_line);
        if (!line) return tl::unexpected(line.error());
        if (!is_text_line(*line)) {
            const auto cause = header_line_fault(*line, raw_longest_line);
            if (cause.empty()) return header;
            return tl::unexpected(error_at(bytes.name(), bytes.offset(), cause));
        }
        if (lines == raw_most_lines) {
            return tl::unexpected(
                error_at(bytes.name(), bytes.offset(), "more than 1000 header lines"));
        }
        auto text = trimmed(line->substr(1));
        text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
        if (auto ok = read_line(header, text); !ok) {
            return tl::unexpected(error_at(bytes.name(), bytes.offset(), ok.error().message));
        }
        const bool ends = text == "end";
        bytes.consume(line->size());
        if (ends) return header;
    }
}

}  // namespace pursuit::sensor
