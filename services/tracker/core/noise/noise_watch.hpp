// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "services/common/event.hpp"
#include "services/tracker/core/noise/clutter.hpp"
#include "services/tracker/core/noise/lookout.hpp"
#include "services/tracker/core/noise/slow_lookout.hpp"

namespace pursuit::tracker {

/// Keeps an object among strong steady noise: an estimator that takes one event at a time cannot
/// tell there that an object stands, nor that it has set out, and is carried off.
///
///     off ── strong steady noise ──► unseen ── it stands out where it is, or nearby ──► sighted
///      ▲                             ▲ held      back where it was, unless confirmed ─┐    │
///      └── less noise ──             └────────────────────────────────────────────────┴────┘
///
/// What stands out by chance is gone a few looks later, and the object is put back; what stands out
/// plainly or goes on to stand out is confirmed. Until it has shown once, and when what comes seems
/// to be noise alone, less noise counts for strong. Where other things make events beside it, what
/// looks say does not hold: it is left alone.
class NoiseWatch {
 public:
    NoiseWatch() = default;
    explicit NoiseWatch(const Contour& contour) : lookout_(contour), slow_(contour) {}

    /// Begins anew with an object at this pose, going so.
    void restart(const Pose& pose, const Velocity& velocity);

    /// Among noise; otherwise nothing is told.
    [[nodiscard]] bool is_on() const { return is_on_; }
    /// Among noise, and not left alone: where what is on the contour is plainly the object's, and
    /// where what lies beside it is no noise, the estimator needs no help.
    [[nodiscard]] bool helps() const { return is_on_ && !is_left_alone_; }
    /// Whether it is known what silence means: not among the edges of other things in noise, nor in
    /// noise while nobody looks what lies beside the object.
    [[nodiscard]] bool knows_silence() const {
        return is_on_ ? looks_ >= first_looks && !is_uneven_ : !is_noisy_;
    }
    /// Whether it is to be held where it is.
    [[nodiscard]] bool is_unseen() const { return is_on_ && !is_sighted_; }
    /// Whether it shows where it is thought to be, plainly or not, and nothing nearby does better.
    [[nodiscard]] bool is_seen_here() const { return is_on_ && is_confirmed_ && is_seen_here_; }
    /// Whether it stands out plainly, has done so for a while, and nothing else does better.
    [[nodiscard]] bool is_sure() const { return is_on_ && plain_looks_ >= sure_looks; }

    /// An event about the object.
    void see(const Event& event) { lookout_.see(event); }
    /// It is another object's: if it was seen last, it shows nothing of this one.
    void disown(const Event& event) { lookout_.disown(event); }

    [[nodiscard]] bool is_due(std::int64_t t_us) const { return t_us >= due_us_; }

    /// Where to put the object, if not where it is thought to be; or, as it is left alone, how it
    /// creeps. gyration_px, extent_px: of the contour in the image.
    std::optional<Coast> look(const Coast& own, const Clutter& clutter, double visible_share,
                              double gyration_px, double extent_px);

    /// A pixel. What is less carries nothing off.
    static constexpr double strong_hz = 3.5;

 private:
    static constexpr int first_looks = 2;  // before they tell anything
    static constexpr int sure_looks = 12;

    void hold(const Coast& where) {
        held_ = where;
        held_.velocity = {};
        is_confirmed_ = false;
    }
    std::optional<Coast> look_slowly(const Coast& own, double gyration_px);
    void tell_noise(const Clutter& clutter, double visible_share);

    Lookout lookout_;
    SlowLookout slow_;
    Coast start_;
    Coast held_;  // where it was when it was seen last
    bool is_on_ = false;
    bool is_noisy_ = false;  // strong steady noise, on or not
    bool is_left_alone_ = false;
    bool is_uneven_ = false;  // what fires beside it
    bool is_sighted_ = false;
    bool is_confirmed_ = false;
    bool is_seen_here_ = false;  // as of the last look
    bool has_shown_ = false;     // for a while, since it began or seemed to be gone
    bool is_creeping_ = false;   // where it is held
    double noise_hz_ = 0;        // when it was steady
    int looks_ = 0;
    int creeping_looks_ = 0;  // in turn
    int plain_looks_ = 0;     // in turn
    int sighted_looks_ = 0;   // since it was put there
    std::int64_t began_us_ = -1;
    std::int64_t due_us_ = 0;
};

}  // namespace pursuit::tracker
