// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace pursuit::tracker {

/// How fast an object moves, told by the rate of its events: an edge of length L that crosses u px
/// makes ρ·L·u events. ρ is learnt from ways that were really gone.
class EventClock {
 public:
    void restart() {
        events_ = 0;
        time_s_ = 0;
        way_events_ = 0;
        way_time_s_ = 0;
    }

    /// The rate is told anew.
    void restart_rate() {
        events_ = 0;
        time_s_ = 0;
    }

    /// dt_s went by.
    void wait(double dt_s) {
        time_s_ += dt_s;
        way_time_s_ += dt_s;
    }

    /// An event that is the object's with probability `share`.
    void count(double share) {
        events_ += share;
        way_events_ += share;
        if (events_ > window_events) {
            time_s_ *= window_events / events_;
            events_ = window_events;
        }
    }

    /// Whether enough events came since the restart to tell.
    [[nodiscard]] bool is_told() const { return events_ >= least_events; }

    /// px/s, for a contour of effective length L px.
    [[nodiscard]] double speed_px_s(double length_px) const {
        return time_s_ > 0 ? events_ / (time_s_ * density_ * length_px) : 0;
    }

    /// Events a px of way.
    [[nodiscard]] double events_per_px(double length_px) const { return density_ * length_px; }

    /// Learns from the net way gone since begin_way(); true where a new one shall begin.
    /// way2_px2: its square.
    bool end_way(double way2_px2, double length_px) {
        if (way2_px2 < least_way_px * least_way_px) return way_time_s_ > longest_way_s;
        const double measured = way_events_ / (std::sqrt(way2_px2) * length_px);
        density_ *= std::pow(std::clamp(measured / density_, 0.5, 2.0), 0.3);
        density_ = std::clamp(density_, 0.5, 12.0);
        return true;
    }
    void begin_way() {
        way_events_ = 0;
        way_time_s_ = 0;
    }

    [[nodiscard]] double density() const { return density_; }

 private:
    static constexpr double window_events = 40;
    static constexpr double least_events = 10;
    static constexpr double least_way_px = 4;
    static constexpr double longest_way_s = 0.3;

    double density_ = 2;  // ρ, events/px²
    double events_ = 0;
    double time_s_ = 0;
    double way_events_ = 0;
    double way_time_s_ = 0;
};

}  // namespace pursuit::tracker
