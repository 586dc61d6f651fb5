// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/spdlog.h>

#include "config.pb.h"

namespace pursuit {

/// Sets up the log of this process: standard error, one line an entry. Under systemd each line
/// begins with the journal's priority ("<4>…") and carries no time of its own; elsewhere it has
/// time and level. The middleware's own log goes the same way.
/// Use spdlog::debug/info/warn/error. Threads: any.
void start_log(const disk::Log& settings);

}  // namespace pursuit
