// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "services/tracker/core/life/fade.hpp"

namespace pursuit::tracker {

/// Whether the events near a track fit its pose. Events of the object lie on the contour; what else
/// comes lies anywhere in the gate: the share within a quarter of the gate tells them apart, a
/// quarter meaning nothing fits. A running mean over the last events.
///
/// An object that stands still makes no events, and the noise that is left says nothing about its
/// pose: while events come at less than a quarter of the object's own rate, it is quiet, and what
/// comes does not count against it.
class Health {
 public:
    void restart(double sharpness = begin) { *this = Health(sharpness); }

    Health() = default;

    /// Some events of those within the gate, the last at this time: how many of them within a
    /// quarter of it; `is_noise` where noise alone comes.
    void count(int sharp, int all, std::int64_t t_us, bool is_noise = false) {
        if (events_ > 0) {
            const double dt_s = static_cast<double>(t_us - t_us_) * 1e-6;
            recent_ *= fade_.over(t_us - t_us_);
            // While it fits, the rate is the object's own.
            if (!is_quiet_ && sharpness_ > begin_of_fit) {
                own_rate_ += (recent_ - own_rate_) * std::min(1.0, dt_s / own_memory_s);
            }
        }
        t_us_ = t_us;
        recent_ += all;
        events_ = std::min(events_ + all, window_events);
        is_quiet_ = is_noise || recent_ < own_rate_ / 4;
        if (!is_quiet_) {
            // Over the last 17 ms where events are many: noise that hides most of them is steady.
            window_ = std::clamp(recent_ / 3, window_events, most_events);
            sharpness_ += (sharp - all * sharpness_) / window_;
            if (sharpness_ > begin_of_fit) {
                usual_count_ = std::min(usual_count_ + all, usual_events);
                usual_sharpness_ += all * (sharpness_ - usual_sharpness_) / usual_count_;
            }
            quiet_sharpness_ = nothing_fits;
            lively_t_us_ = t_us;
            return;
        }
        quiet_sharpness_ += (sharp - all * quiet_sharpness_) / window_events;
        if (!is_noise && quiet_sharpness_ > good) own_rate_ = recent_;  // It moves, only slower.
    }

    [[nodiscard]] double sharpness() const { return sharpness_; }
    [[nodiscard]] double usual_sharpness() const { return usual_sharpness_; }
    /// The same beside what is usual for the object, 0 … 1 and a little more.
    [[nodiscard]] double relative_sharpness() const { return sharpness_ / usual_sharpness_; }
    /// Whether enough events came since the restart to tell.
    [[nodiscard]] bool is_settled() const { return events_ >= window_events; }
    /// Whether the events counted last came in a quiet time.
    [[nodiscard]] bool is_quiet() const { return is_quiet_; }
    /// The last event that did not.
    [[nodiscard]] std::int64_t lively_t_us() const { return lively_t_us_; }

    /// Events a second within the gate, over the last 50 ms.
    [[nodiscard]] double rate_hz(std::int64_t t_us) const {
        const double dt_s = static_cast<double>(t_us - t_us_) * 1e-6;
        return recent_ / memory_s * std::exp(-dt_s / memory_s);
    }

    /// The same while the events fitted and it was not quiet; over the last half second.
    [[nodiscard]] double usual_rate_hz() const { return own_rate_ / memory_s; }

    /// Whether the events speak against the pose: at chance or far from what is usual for the
    /// object, from a part of the contour alone, or a little of both.
    [[nodiscard]] bool is_against(double let_go_sharpness, double cover) const {
        // The more events the mean is over, the nearer to chance it can tell.
        const double above_chance =
            (let_go_sharpness - nothing_fits) * std::sqrt(window_events / window_);
        return sharpness_ < std::max(nothing_fits + above_chance, much_less * usual_sharpness_) ||
               cover < bad_cover || (sharpness_ < doubtful && cover < doubtful_cover);
    }

    /// Between the two nothing changes: a track is not given up and taken up by turns.
    [[nodiscard]] bool is_good() const { return sharpness_ > good; }
    [[nodiscard]] bool is_fair() const { return sharpness_ > begin_of_fit; }
    /// Whether as many fit as nearly always: what is missing is hidden, and what comes is its own.
    [[nodiscard]] bool is_as_usual() const {
        return is_fair() && sharpness_ > nearly_usual * usual_sharpness_;
    }
    [[nodiscard]] bool is_below(double sharpness) const { return sharpness_ < sharpness; }

    static constexpr double begin = 0.5;
    // Nothing fits at 0.25; models taken from a real recording reach 0.45 to 0.6, others 0.7 to 1.
    // The mean strays by 0.03.
    static constexpr double good = 0.5;
    static constexpr double good_cover = 0.65;
    static constexpr double bad_cover = 0.5;

 private:
    explicit Health(double sharpness) : sharpness_(sharpness) {}

    static constexpr double nothing_fits = 0.25;
    static constexpr double begin_of_fit = 0.42;
    static constexpr double window_events = 150;
    static constexpr double most_events = 2000;
    static constexpr double usual_events = 10'000;
    static constexpr double much_less = 0.55;
    // Half way to where it is let go: with another shape's side on one of its own half of it fits.
    static constexpr double nearly_usual = 0.75;
    static constexpr double doubtful = 0.42;
    static constexpr double doubtful_cover = 0.75;
    static constexpr double memory_s = 0.05;
    static constexpr double own_memory_s = 0.5;
    static const inline Fade fade_{memory_s};

    double sharpness_ = begin;
    double usual_sharpness_ = begin;
    double usual_count_ = window_events;
    double quiet_sharpness_ = nothing_fits;
    double events_ = 0;
    double recent_ = 0;  // events of the last 50 ms, fading
    double window_ = window_events;
    double own_rate_ = 0;  // the same while the events fitted
    bool is_quiet_ = false;
    std::int64_t t_us_ = 0;
    std::int64_t lively_t_us_ = 0;
};

}  // namespace pursuit::tracker
