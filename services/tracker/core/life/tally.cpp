// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/tally.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::tracker {

double Going::visible_share(const Outline& outline, double radius_px) const {
    // Also a part that moves along itself makes some events.
    constexpr double sideways_share = 0.1;
    const double speed_px_s =
        std::hypot(velocity_.vx_px_s, velocity_.vy_px_s, velocity_.omega_rad_s * radius_px) + 1e-9;
    double seen = 0;
    double whole = 0;
    for (const Outline::Part& part : outline.parts()) {
        const double shows = across_px_s(part, arm_px_of(part.middle_px)) / speed_px_s +
                             sideways_share * (a_ * part.along_px).norm();
        whole += shows;
        if (!part.is_hidden) seen += shows;
    }
    return whole > 0 ? seen / whole : 1;
}

void Tally::begin(std::int64_t t_us) {
    over_s_ = t_us_ < 0 ? 0 : static_cast<double>(t_us - t_us_) * 1e-6;
    t_us_ = t_us;
}

void Tally::learn(const Outline& outline, const Going& going) {
    for (const Outline::Part& part : outline.parts()) {
        if (part.is_hidden) continue;
        events_ += part.events;
        px2_ += going.across_px_s(part, going.arm_px_of(part.middle_px)) * over_s_;
    }
    if (events_ > most_events) {
        px2_ *= most_events / events_;
        events_ = most_events;
    }
    // With what is usual for a start.
    events_per_px2_ = std::clamp((events_ + 200) / (px2_ + 100), 0.2, 12.0);
}

}  // namespace pursuit::tracker
