// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "services/ctl/report/report.hpp"

namespace pursuit::ctl {

/// The page's tables: objects, latencies and counts, versions and configuration. Each holds at most
/// limits.table_rows rows.
std::string render_tables(const Report& report, const ReportLimits& limits);

}  // namespace pursuit::ctl
