// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace pursuit::tracker {

/// How long a pixel of this sensor is blind after an event: none is shorter than its refractory
/// period, and where edges follow each other closely, or make several events, some are little
/// longer. Told from above by what one in 200 of them is shorter than; noise and the rare events of
/// a quiet scene make it longer than it is, but then nothing is so fast that it would matter.
class Refractory {
 public:
    void restart() { period_us_ = usual_us; }

    /// Of any event: how long ago its pixel fired before it, whichever polarity.
    void see(std::int64_t since_us) {
        const auto since = static_cast<double>(since_us);
        period_us_ = std::clamp(period_us_ * (since < period_us_ ? shorter : longer), shortest_us,
                                longest_us);
    }

    [[nodiscard]] double period_us() const { return period_us_; }

 private:
    static constexpr double share = 0.005;
    static constexpr double step = 0.03;
    static constexpr double shorter = 1 - step;
    static constexpr double longer = 1 + step * share / (1 - share);
    static constexpr double shortest_us = 1;  // of what stamps tell
    static constexpr double usual_us = 1'000;
    static constexpr double longest_us = 10'000;

    double period_us_ = usual_us;
};

}  // namespace pursuit::tracker
