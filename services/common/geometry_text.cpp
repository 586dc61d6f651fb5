// SPDX-License-Identifier: Apache-2.0
#include "services/common/geometry_text.hpp"

#include <charconv>

namespace pursuit {
namespace {

constexpr std::uint16_t most_rows = 32768;

}  // namespace

std::optional<Geometry> parse_geometry(std::string_view text) {
    Geometry geometry;
    const auto* end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, geometry.width);
    if (width.ec != std::errc() || width.ptr == end || *width.ptr != 'x') return std::nullopt;
    const auto height = std::from_chars(width.ptr + 1, end, geometry.height);
    if (height.ec != std::errc() || height.ptr != end) return std::nullopt;
    if (geometry.width == 0 || geometry.height == 0 || geometry.height > most_rows) {
        return std::nullopt;
    }
    return geometry;
}

}  // namespace pursuit
