// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "services/tracker/core/geometry/contour.hpp"
#include "services/tracker/core/geometry/outline.hpp"
#include "services/tracker/core/geometry/pose.hpp"
#include "services/tracker/core/life/cover.hpp"
#include "services/tracker/core/life/health.hpp"

namespace pursuit::tracker {

/// How well its events hold a track: whether they fit its pose (Health), whether they come from all
/// of its contour (Cover), and for how long they have spoken against the pose.
///
/// Events are counted one by one and weighed some together, when is_due() and when the track's time
/// goes on: what they say changes over hundreds. Thread: the tracker's.
class Grip {
 public:
    Grip() = default;
    explicit Grip(const Contour& contour) : cover_(contour) {}

    /// Nothing speaks against the pose, and the events are thought to fit it so well.
    void restart(double sharpness = Health::begin) {
        health_.restart(sharpness);
        cover_.restart();
        forgive();
    }
    /// What has spoken against the pose, and what was counted and not weighed, is no more of
    /// interest.
    void forgive() {
        against_us_ = 0;
        sharp_ = counted_ = 0;
        looked_us_ = 0;
        whole_us_ = never_us;
    }
    /// Another contour is held the same way.
    void hold(const Contour& contour) { cover_ = Cover(contour); }

    /// An event of those within the gate, on the contour (within a quarter of the gate) or not.
    void count(bool is_sharp) {
        ++counted_;
        sharp_ += is_sharp ? 1 : 0;
    }
    /// One that was on this piece of the contour, and moved the pose.
    void count_place(std::int32_t piece) { cover_.count(piece); }

    /// So many are weighed together.
    static constexpr int together = 24;
    /// Whether as many were counted.
    [[nodiscard]] bool is_due() const { return counted_ >= together; }
    /// Whether any were.
    [[nodiscard]] bool is_counting() const { return counted_ > 0; }
    [[nodiscard]] int sharp() const { return sharp_; }
    [[nodiscard]] int astray() const { return counted_ - sharp_; }

    /// Weighs what was counted, the last at this time; is_noise: noise alone comes; is_seen: it
    /// shows here among noise that hides most of its events.
    void weigh(std::int64_t t_us, bool is_noise, bool is_seen, double let_go_sharpness) {
        health_.count(sharp_, counted_, t_us, is_noise);
        sharp_ = counted_ = 0;
        const std::int64_t dt_us = std::clamp<std::int64_t>(t_us - weighed_us_, 0, longest_step_us);
        weighed_us_ = t_us;
        const bool is_against = !is_noise && !is_seen && health_.is_settled() &&
                                health_.is_against(let_go_sharpness, cover_.share());
        if (!is_against && against_us_ == 0) return;
        against_us_ = std::max<std::int64_t>(against_us_ + (is_against ? dt_us : -2 * dt_us), 0);
    }
    /// Whether enough came to look where they come from, every 2 ms at most.
    [[nodiscard]] bool is_due_to_look(std::int64_t t_us) const {
        return cover_.is_due() && t_us - looked_us_ >= look_every_us;
    }
    /// Looks where they come from.
    void look_around(std::int64_t t_us, const Outline& outline, const Pose& pose,
                     const Velocity& velocity) {
        looked_us_ = t_us;
        cover_.close_window(outline, pose, velocity);
        if (cover_.share() > nearly_all || whole_us_ == never_us) whole_us_ = t_us;
    }
    /// True once in a while as long as a part of the contour makes too few events, though it moves.
    [[nodiscard]] bool is_patchy(std::int64_t t_us) {
        if (whole_us_ == never_us || t_us - whole_us_ < patchy_us) return false;
        whole_us_ = t_us;
        return true;
    }

    [[nodiscard]] const Health& health() const { return health_; }
    [[nodiscard]] bool is_against() const { return against_us_ > 0; }
    [[nodiscard]] bool is_lost() const { return against_us_ > let_go_after_us; }

    /// How well the pose fits, of the events alone: 0 … 1.
    [[nodiscard]] double fit() const {
        const double sharp = std::clamp((health_.sharpness() - 0.25) / 0.4, 0.0, 1.0);
        const double usual = std::clamp((health_.relative_sharpness() - 0.6) / 0.25, 0.0, 1.0);
        const double covered = std::clamp((cover_.share() - 0.4) / 0.2, 0.0, 1.0);
        return std::min({sharp, usual, covered});
    }

 private:
    // The events must speak against the pose for this long, less what they speak for it twice:
    // models taken from a real recording, and the first moments of slow objects among noise, do so
    // for a while.
    static constexpr std::int64_t let_go_after_us = 60'000;
    static constexpr std::int64_t longest_step_us = 20'000;
    static constexpr std::int64_t look_every_us = 2'000;
    // Of a pose that is right and turns fast the cover falls below it for up to 50 ms.
    static constexpr double nearly_all = 0.8;
    static constexpr std::int64_t patchy_us = 100'000;
    static constexpr std::int64_t never_us = -1;

    Health health_;
    Cover cover_;
    int counted_ = 0;  // and not yet weighed
    int sharp_ = 0;    // of these
    std::int64_t against_us_ = 0;
    std::int64_t weighed_us_ = 0;
    std::int64_t looked_us_ = 0;
    std::int64_t whole_us_ = never_us;  // the last look that found nearly all of it
};

}  // namespace pursuit::tracker
