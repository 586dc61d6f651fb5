// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "services/common/event.hpp"
#include "services/tracker/core/large_table.hpp"

namespace pursuit::tracker {

/// When each pixel last fired, a polarity each.
class RecentPixels {
 public:
    static constexpr std::int64_t never_us = std::numeric_limits<std::int64_t>::max() / 2;

    void restart(Geometry geometry) {
        width_ = geometry.width;
        last_us_.assign(std::size_t{2} * geometry.width * geometry.height, -never_us);
    }

    /// Soon note() is called for this event: its pixel is fetched from memory meanwhile.
    void prefetch(const Event& event) const {
        const std::size_t at =
            2 * (std::size_t{event.y} * width_ + event.x) + (event.polarity & 1U);
        if (at < last_us_.size()) __builtin_prefetch(&last_us_[at], 1);
    }

    /// µs since the same pixel fired with the same polarity, and notes this event.
    std::int64_t note(const Event& event) {
        std::int64_t& last_us =
            last_us_[2 * (std::size_t{event.y} * width_ + event.x) + (event.polarity & 1U)];
        const std::int64_t since_us = event.t_us - last_us;
        last_us = event.t_us;
        return since_us;
    }

 private:
    std::size_t width_ = 0;
    LargeTable<std::int64_t> last_us_;
};

}  // namespace pursuit::tracker
