// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pursuit::tracker::bench {

/// How often this program has asked for memory by operator new so far. Threads: one.
std::uint64_t allocations();

}  // namespace pursuit::tracker::bench
