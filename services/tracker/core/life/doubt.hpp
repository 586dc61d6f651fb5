// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "services/tracker/core/geometry/coast.hpp"

namespace pursuit::tracker {

/// Whether a pose that its events seem to fit is yet to be confirmed: an estimator holds on to what
/// is nearest to where it began, right or not. From the start, when it was found again and after a
/// silence, searches around the pose must find nothing that fits better, some in turn.
///
///     settled ── begin() ──► open ── confirmed, some times in turn ──► settled
///                             │ ▲
///                             └─┘ nothing is sure; after many of them: settled
class Doubt {
 public:
    /// What a search around the pose found.
    struct Finding {
        bool is_here = true;   ///< The best lies where the object is thought to be.
        bool is_told = true;   ///< Whether what was found is worth anything …
        bool is_sure = false;  ///< … and tells by itself.
        double gain = 0;       ///< How much more of the contour the best explains.
        Eigen::Vector2d off_px = Eigen::Vector2d::Zero();  ///< Of the best from the pose.
    };

    /// Events before `since_us` tell nothing. `before` is where the object was when it fell silent.
    void begin(std::int64_t t_us, int confirmations, std::int64_t since_us,
               std::optional<Coast> before = std::nullopt) {
        *this = Doubt();
        wanted_ = confirmations;
        since_us_ = since_us;
        due_us_ = t_us + first_us;
        before_ = before;
    }

    /// To be called when it begins because the object was moved to what it found. Each time more is
    /// wanted of the next: where a model fits in part only, several places are as good as each
    /// other, and the object would be moved to and fro between them.
    void begin_again(std::int64_t t_us, int confirmations) {
        const int moves = moves_ + 1;
        begin(t_us, confirmations, since_us_);
        moves_ = moves;
    }

    /// Nothing is known of how the object lies.
    void leave_angle_open() { is_angle_open_ = true; }
    [[nodiscard]] bool is_angle_open() const { return is_angle_open_; }

    void settle() { wanted_ = 0; }

    [[nodiscard]] bool is_open() const { return wanted_ > 0; }
    [[nodiscard]] bool is_due(std::int64_t t_us) const { return wanted_ > 0 && t_us >= due_us_; }
    [[nodiscard]] std::int64_t since_us() const { return since_us_; }
    [[nodiscard]] const std::optional<Coast>& before() const { return before_; }

    /// How many searches were made.
    [[nodiscard]] int tries() const { return tries_; }

    /// Not enough events for a search: later, and later again.
    void wait(std::int64_t t_us) {
        due_us_ = t_us + wait_us_;
        wait_us_ = std::min(2 * wait_us_, longest_wait_us);
    }

    /// True where the object is to be moved to what was found. One finding may tell; else what
    /// several in turn gain adds up.
    bool take(std::int64_t t_us, const Finding& finding) {
        due_us_ = t_us + (finding.is_here ? next_us : soon_us) * std::clamp(tries_, 2, 6) / 2;
        if (++tries_ >= most_tries) wanted_ = 0;
        wait_us_ = first_us;
        if (!finding.is_told) return false;
        if (finding.is_here) {
            for_move_ = std::min(for_move_, 0.0) - usual_gain;
        } else if (for_move_ <= 0 || (finding.off_px - off_px_).norm() < same_off_px) {
            for_move_ += std::min(finding.gain, 2 * usual_gain);
        } else {
            for_move_ = std::min(finding.gain, usual_gain);
        }
        off_px_ = finding.off_px;
        const int times = 1 + moves_;
        if (finding.is_sure && !finding.is_here) return finding.gain > usual_gain * times;
        if (for_move_ > enough * times) return true;
        if ((finding.is_here && finding.is_sure) || for_move_ < -enough) {
            --wanted_;
            for_move_ = 0;
            before_.reset();
        }
        return false;
    }

 private:
    static constexpr std::int64_t first_us = 2'000;
    static constexpr std::int64_t next_us = 10'000;
    static constexpr std::int64_t longest_wait_us = 32'000;
    static constexpr std::int64_t soon_us = 5'000;
    static constexpr int most_tries = 40;
    static constexpr double usual_gain = 0.1;
    static constexpr double enough = 0.25;
    static constexpr double same_off_px = 3;

    bool is_angle_open_ = false;
    int moves_ = 0;
    int wanted_ = 0;
    int tries_ = 0;
    std::int64_t since_us_ = 0;
    std::int64_t due_us_ = 0;
    std::int64_t wait_us_ = first_us;
    double for_move_ = 0;
    Eigen::Vector2d off_px_ = Eigen::Vector2d::Zero();
    std::optional<Coast> before_;
};

}  // namespace pursuit::tracker
