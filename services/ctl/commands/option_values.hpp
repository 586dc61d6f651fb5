// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "services/common/event.hpp"
#include "services/common/result.hpp"

namespace pursuit::ctl {

inline constexpr const char* geometry_help = "Pixels, WxH, instead of what the recording states";

/// "Format, where the file does not tell: dat, es, …"
std::string format_help();

/// "640x480"; empty text: none.
Result<std::optional<Geometry>> geometry_of(const std::string& text);

}  // namespace pursuit::ctl
