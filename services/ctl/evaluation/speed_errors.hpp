// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/ctl/evaluation/pairs.hpp"
#include "services/ctl/evaluation/score.hpp"

namespace pursuit::ctl {

/// Slopes of truth plus error against those of the truth over the same window: what a pose on a
/// grid adds to the truth between its times is no error of speed. Half width of
/// the windows in seconds; 0: the turning rate alone.
void score_speeds(const Pairs& pairs, double window_s, Score& score);

}  // namespace pursuit::ctl
