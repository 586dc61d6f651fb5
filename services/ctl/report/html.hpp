// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace pursuit::ctl {

/// Text as HTML content or attribute value: the five special characters escaped, control characters
/// and broken UTF-8 replaced, cut at `max_bytes` of input.
std::string escape_html(std::string_view text, std::size_t max_bytes);

/// A number for a reader: `digits` after the point, "–" where it is not finite.
std::string number(double value, int digits);

/// The same in short: 1234567 is "1.23 M".
std::string short_number(double value);

/// A coordinate in SVG; the value must be finite.
std::string coordinate(double value);

std::string base64(std::span<const std::uint8_t> data);

}  // namespace pursuit::ctl
