// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "services/tracker/core/estimator/slope.hpp"
#include "services/tracker/core/estimator/usual_way.hpp"
#include "services/tracker/core/geometry/coast.hpp"
#include "services/tracker/core/kinds.hpp"

namespace pursuit::tracker {

/// How an object goes on while another covers all of it: from where it was, at its velocity of the
/// last second, whatever the last events said of it.
///
///     learning ── begin() ──► going on ── (it comes out, or is given up) ──► learning
///
/// Thread: the tracker's.
class HiddenWay {
 public:
    /// Nothing is known of how it goes.
    void restart() { *this = HiddenWay(); }

    /// It was found elsewhere than it was thought to be: how it came there tells nothing of how it
    /// goes. What is known of its last way under another stays.
    void learn_anew();

    /// While it is in view: whether another pose is wanted, and the pose.
    [[nodiscard]] bool is_due(std::int64_t t_us) const { return slow_.is_due(t_us); }
    void learn(std::int64_t t_us, const Pose& pose);

    /// How it has gone so far, once that is known.
    [[nodiscard]] UsualWay usual() const;

    /// It is covered from now on; `now`: what is known of it, its velocity where none was learnt.
    void begin(const Coast& now);
    /// Time went on by dt_s.
    void go_on(std::int64_t t_us, double dt_s, TransformKind transform);
    /// It can move so from now on.
    void constrain(TransformKind transform);

    /// Where it was at the last go_on().
    [[nodiscard]] const Coast& last() const { return coast_; }
    /// Where it is thought to be later: the same, moved along.
    [[nodiscard]] Pose pose_at(std::int64_t t_us) const;

 private:
    static constexpr double memory_s = 0.8;
    static constexpr double quick_memory_s = 0.2;

    Slope<3> slow_{memory_s};  // x, y, θ
    Slope<3> quick_{quick_memory_s};
    double samples_ = 0;
    double strays2_px2_s2_ = 0;  // of the quick velocity from the slow one, squared
    double strays2_rad2_s2_ = 0;
    double theta_rad_ = 0;  // unwrapped
    Coast coast_;
};

}  // namespace pursuit::tracker
