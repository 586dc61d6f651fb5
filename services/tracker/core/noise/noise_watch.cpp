// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/noise_watch.hpp"

#include <utility>

namespace pursuit::tracker {
namespace {

// Once the object has shown where it is, and until it seems to be gone, the estimator does better
// alone where there is less than this: of what is held it is not told how much should come, nor
// therefore what hides it. When it went well for so long without the watch, it has shown.
constexpr double strong_for_shown_hz = 12;
constexpr std::int64_t seen_without_us = 500'000;
// Not so steady any more it is still the noise that it was, within these; an object that comes out
// of it makes it uneven.
constexpr double least_of_noise = 0.6;
constexpr double most_of_noise = 1.6;

// Of it must show.
constexpr double unhidden_share = 0.7;
constexpr double least_visible_share = 0.3;

// What was taken for the first motion was noise as well, unless so much of it was its own.
constexpr std::int64_t start_us = 30'000;
constexpr double own_share_at_start = 0.35;

constexpr int looks_everywhere = 4;  // where it is plain: by turns
constexpr double here_z = 4.5;
constexpr double still_here_z = 2.5;
constexpr double confirmed_z = 6;
constexpr int looks_of_chance = 7;  // longer than what was chance is looked at
constexpr double plain_z = 8;
// By what fired in 160 ms. (Chance lifts the best of all ways to 4, as a rule.)
constexpr double creeping_z = 6;
constexpr double still_creeping_z = 4.8;
constexpr double longest_s = 1;
// Where so much of what is on the contour is its own, the estimator needs no help: it follows what
// turns too fast for a look.
constexpr double plain_share = 0.5;

}  // namespace

void NoiseWatch::restart(const Pose& pose, const Velocity& velocity) {
    start_ = held_ = {0, pose, velocity};
    is_on_ = is_noisy_ = is_left_alone_ = is_uneven_ = is_sighted_ = is_confirmed_ = is_seen_here_ =
        false;
    looks_ = plain_looks_ = sighted_looks_ = 0;
    is_creeping_ = has_shown_ = false;
    creeping_looks_ = 0;
    began_us_ = -1;
    due_us_ = 0;
}

void NoiseWatch::tell_noise(const Clutter& clutter, double visible_share) {
    // Not so steady any more it is still the noise that it was, as far as there is so much.
    const double hz = clutter.noise_hz();
    is_noisy_ = clutter.is_steady() ? hz > strong_hz : is_noisy_ && hz > least_of_noise * strong_hz;
    is_on_ &= clutter.can_be_noise(noise_hz_);
    // Beside what hides it in part it is not the noise that is counted: then what was known holds.
    if (visible_share < unhidden_share) {
        is_on_ &= visible_share > least_visible_share;
        return;
    }
    if (clutter.is_steady()) {
        has_shown_ &= !clutter.is_noise_alone();
        is_on_ = hz > (has_shown_ ? strong_for_shown_hz : strong_hz);
        noise_hz_ = hz;
    } else if (is_on_) {
        is_on_ = hz > least_of_noise * noise_hz_ && hz < most_of_noise * noise_hz_;
    }
}

std::optional<Coast> NoiseWatch::look(const Coast& own, const Clutter& clutter,
                                      double visible_share, double gyration_px, double extent_px) {
    // Among noise there is no silence. After one nothing is known of where it went meanwhile.
    if (own.t_us > due_us_ + Lookout::every_us) {
        lookout_.restart();
        slow_.restart();
        is_noisy_ = is_left_alone_ = is_uneven_ = false;
        looks_ = plain_looks_ = sighted_looks_ = 0;
    }
    due_us_ = own.t_us + Lookout::every_us;
    if (began_us_ < 0) began_us_ = own.t_us;
    const bool was_on = is_on_;
    has_shown_ |= !was_on && own.t_us - began_us_ > seen_without_us;
    tell_noise(clutter, extent_px < Lookout::most_extent_px ? visible_share : 0);
    if (!is_on_) {
        // The estimator goes on as it was seen to go.
        if (!std::exchange(is_creeping_, false)) return std::nullopt;
        return held_.at(own.t_us, longest_s);
    }
    if (!was_on) {
        is_left_alone_ = is_uneven_ = false;
        is_seen_here_ = false;
        lookout_.restart();
        slow_.restart();
        lookout_.look(own, gyration_px, extent_px, false);
        looks_ = plain_looks_ = sighted_looks_ = 0;
        const Velocity& v = start_.velocity;
        const bool stood = v.vx_px_s == 0 && v.vy_px_s == 0 && v.omega_rad_s == 0;
        const bool is_fresh =
            stood && own.t_us - began_us_ < start_us && clutter.own_share() < own_share_at_start;
        hold(is_fresh ? start_ : own);
        is_sighted_ = is_confirmed_ = !is_fresh && !clutter.is_noise_alone();
        if (is_fresh) return held_;
        return std::nullopt;
    }
    // What Lookout sees tells nothing of how it goes when it is slow.
    if (is_sighted_) slow_.restart();
    slow_.add(lookout_.fresh(), own.pose.t_px, extent_px);
    const bool everywhere = plain_looks_ == 0 || looks_ % looks_everywhere == 0;
    const Lookout::Sight sight = lookout_.look(own, gyration_px, extent_px, everywhere);
    const double own_z = sight.own_z;
    // Where other things make events, what stands out tells nothing.
    is_uneven_ = !sight.is_even;
    const bool nothing_better = sight.is_even && !sight.instead;
    is_seen_here_ = own_z > still_here_z && nothing_better;
    plain_looks_ = own_z > plain_z && nothing_better ? plain_looks_ + 1 : 0;
    if (++looks_ < first_looks) return std::nullopt;
    is_left_alone_ = is_uneven_ || clutter.own_share() > plain_share;
    if (is_left_alone_) {
        is_sighted_ = is_confirmed_ = true;
        is_creeping_ = false;
        return std::nullopt;
    }
    if (sight.instead) {
        if (is_confirmed_) hold(own);
        is_sighted_ = true;
        is_creeping_ = false;
        sighted_looks_ = 0;
        return lookout_.nearest_turn(*sight.instead, theta_rad(held_.pose.a));
    }
    is_sighted_ = own_z > (is_sighted_ ? still_here_z : here_z);
    sighted_looks_ = is_sighted_ ? sighted_looks_ + 1 : 0;
    is_confirmed_ |= own_z > confirmed_z || sighted_looks_ > looks_of_chance;
    has_shown_ |= sighted_looks_ >= sure_looks;
    if (is_sighted_) {
        is_creeping_ = false;
        return std::nullopt;
    }
    return look_slowly(own, gyration_px);
}

// It does not stand out by what fired in the last 20 ms.
std::optional<Coast> NoiseWatch::look_slowly(const Coast& own, double gyration_px) {
    if (is_confirmed_) hold(own);
    held_ = held_.at(own.t_us, longest_s);
    if (slow_.is_due()) {
        const SlowLookout::Sight sight = slow_.look(held_, gyration_px);
        is_creeping_ =
            is_creeping_ ? sight.z > still_creeping_z : sight.z > creeping_z && sight.is_all_around;
        if (is_creeping_) {
            has_shown_ |= ++creeping_looks_ >= sure_looks;
            held_ = sight.best;
        } else {
            creeping_looks_ = 0;
            held_.velocity = {};
        }
    }
    return held_;
}

}  // namespace pursuit::tracker
