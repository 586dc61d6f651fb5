// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pursuit::tracker::bench {

/// Registers what is measured as a ratio: things that take turns on the same events in one run, so
/// that what disturbs one disturbs the other. Counters in ns an event are medians over the turns.
///   ratio/scalar/points:N/rate_khz:R   the tracker beside the paper read plainly
///   ratio/objects:N                    N objects beside one
void add_ratios();

}  // namespace pursuit::tracker::bench
