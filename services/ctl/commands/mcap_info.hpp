// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace pursuit::ctl {

/// Whether the file begins as an MCAP recording does, whatever its name.
bool is_mcap(const std::string& path);

/// Prints what an MCAP recording holds, as a text or as one JSON object. full: reads and checks
/// everything; otherwise the summary is taken where the file was closed. The exit code is 1 where
/// the file is damaged or was not closed.
int print_mcap_info(const std::string& path, bool full, bool json);

}  // namespace pursuit::ctl
