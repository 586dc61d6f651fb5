// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/ctl/evaluation/score.hpp"
#include "services/ctl/evaluation/track_table.hpp"
#include "services/ctl/recording/recorded_run.hpp"
#include "services/ctl/report/report.hpp"

namespace pursuit::ctl {

/// Poses of a run as the evaluation takes them.
std::vector<ObjectRows> object_rows(const RecordedRun& run);

/// The page of a run; `truth` may be empty, and then there are no errors on it. Truth after the
/// recording's end is none of the run.
Report make_report(const RecordedRun& run, const std::vector<ObjectRows>& truth,
                   const std::string& title);

}  // namespace pursuit::ctl
