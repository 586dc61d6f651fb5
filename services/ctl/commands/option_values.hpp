// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "services/common/event.hpp"
#include "services/common/result.hpp"

namespace pursuit::ctl {

inline constexpr const char* geometry_help = "Pixels, WxH, instead of what the recording states";

/// "Format, where the file does not tell: dat, es, …"
std::string format_help();

/// As CLI::Range, which lets a NaN through: it is neither below nor above.
CLI::Validator finite_range(double least, double most);

/// "640x480"; empty text: none.
Result<std::optional<Geometry>> geometry_of(const std::string& text);

}  // namespace pursuit::ctl
