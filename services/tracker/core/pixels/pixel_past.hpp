// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

namespace pursuit::tracker {

/// How long before an event its pixel had fired, µs.
struct PixelPast {
    static constexpr std::int64_t never_us = std::numeric_limits<std::int64_t>::max() / 2;

    std::int64_t since_same_us = never_us;   ///< With the same polarity.
    std::int64_t since_other_us = never_us;  ///< With the other.
};

}  // namespace pursuit::tracker
