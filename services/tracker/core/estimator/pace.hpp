// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace pursuit::tracker {

/// How fast an object has gone of late: so fast it may turn away, even where it hardly moves now.
/// What has gone round a bend of so many px at its speed has done with it when it has gone these
/// px: then how it can turn depends on its speed alone. But what turns back, or is shaken by the
/// hand that holds the camera, is slowest just where it is pushed hardest, and a filter that is
/// told that slow things turn slowly gets stiff there: it lags 20 ms behind what trembles at
/// 20 px/s, a third of a pixel and hundreds of events.
///
/// Where the object itself stands and things pass behind it, most of what comes is theirs, and it
/// shall not be carried along: the more of the events are others', the less this counts.
class Pace {
 public:
    void restart() { *this = Pace(); }

    /// It went so fast for dt_s.
    void go(double dt_s, double speed_px_s) {
        mean_speed2_ += (speed_px_s * speed_px_s - mean_speed2_) * dt_s / (dt_s + memory_s);
    }

    /// Now that it goes so fast and this share of what is on its contour is its own: never less
    /// than the speed.
    [[nodiscard]] double px_s(double speed_px_s, double own_share) const {
        const double of_late_px_s = std::sqrt(mean_speed2_);
        if (!(of_late_px_s > speed_px_s)) return speed_px_s;
        return speed_px_s + own_share * own_share * own_share * (of_late_px_s - speed_px_s);
    }

 private:
    // A tremble of the hand, 4 to 11 Hz. From 0.1 to 0.3 it is much the same.
    static constexpr double memory_s = 0.15;

    double mean_speed2_ = 0;
};

}  // namespace pursuit::tracker
