// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "services/common/result.hpp"

namespace pursuit::recorder {

/// `pattern` with every %t replaced by `time_ns` (since 1970) as UTC, "20260102T030405Z".
std::string expand_time(const std::string& pattern, std::int64_t time_ns);

/// Refuses a path at which no wait makes a file possible: its folder is not there or may not be
/// written to, or no file may have such a name. A full disk is not refused.
Result<void> check_output(const std::string& path);

/// The first of "run.mcap", "run-1.mcap", "run-2.mcap", … that does not exist.
std::string free_path(const std::string& path);

}  // namespace pursuit::recorder
