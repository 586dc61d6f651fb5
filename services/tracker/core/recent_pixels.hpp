// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "services/common/event.hpp"
#include "services/tracker/core/large_table.hpp"
#include "services/tracker/core/pixel_past.hpp"

namespace pursuit::tracker {

/// When each pixel last fired, a polarity each.
class RecentPixels {
 public:
    void restart(Geometry geometry) {
        width_ = geometry.width;
        last_us_.assign(std::size_t{2} * geometry.width * geometry.height, -PixelPast::never_us);
    }

    /// Soon note() is called for this event: its pixel is fetched from memory meanwhile.
    void prefetch(const Event& event) const {
        const std::size_t at =
            2 * (std::size_t{event.y} * width_ + event.x) + (event.polarity & 1U);
        if (at < last_us_.size()) __builtin_prefetch(&last_us_[at], 1);
    }

    /// How long since the same pixel fired, and notes this event.
    PixelPast note(const Event& event) {
        const std::size_t pixel = 2 * (std::size_t{event.y} * width_ + event.x);
        const std::size_t polarity = event.polarity & 1U;
        std::int64_t& last_us = last_us_[pixel + polarity];
        const PixelPast past{event.t_us - last_us, event.t_us - last_us_[pixel + (polarity ^ 1U)]};
        last_us = event.t_us;
        return past;
    }

 private:
    std::size_t width_ = 0;
    LargeTable<std::int64_t> last_us_;
};

}  // namespace pursuit::tracker
