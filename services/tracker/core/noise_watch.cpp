// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise_watch.hpp"

namespace pursuit::tracker {
namespace {

// A pixel. Where there is less, the estimator does as well alone.
constexpr double strong_hz = 15;
// Not so steady any more it is still the noise that it was, within these; an object that comes out
// of it makes it uneven.
constexpr double least_of_noise = 0.6;
constexpr double most_of_noise = 1.6;

// What was taken for the first motion was noise as well, unless so much of it was its own.
constexpr std::int64_t start_us = 30'000;
constexpr double own_share_at_start = 0.35;

constexpr int first_looks = 2;
constexpr int looks_everywhere = 4;  // where it is plain: by turns
constexpr double here_z = 4.5;
constexpr double still_here_z = 2.5;
constexpr double confirmed_z = 6;
constexpr int looks_of_chance = 7;  // longer than what was chance is looked at
constexpr double plain_z = 8;
// Where so much of what is on the contour is its own, the estimator needs no help: it follows what
// turns too fast for a look.
constexpr double plain_share = 0.5;

}  // namespace

void NoiseWatch::restart(const Pose& pose, const Velocity& velocity) {
    start_ = held_ = {0, pose, velocity};
    is_on_ = is_sighted_ = is_confirmed_ = false;
    looks_ = plain_looks_ = sighted_looks_ = 0;
    began_us_ = -1;
    due_us_ = 0;
}

void NoiseWatch::tell_noise(const Clutter& clutter, bool can_look) {
    const double hz = clutter.noise_hz();
    if (!can_look) {
        is_on_ = false;
    } else if (clutter.is_steady()) {
        is_on_ = hz > strong_hz;
        noise_hz_ = hz;
    } else if (is_on_) {
        is_on_ = hz > least_of_noise * noise_hz_ && hz < most_of_noise * noise_hz_;
    }
}

std::optional<Coast> NoiseWatch::look(const Coast& own, const Clutter& clutter, bool can_look,
                                      double gyration_px, double extent_px) {
    due_us_ = own.t_us + Lookout::every_us;
    if (began_us_ < 0) began_us_ = own.t_us;
    const bool was_on = is_on_;
    tell_noise(clutter, can_look && extent_px < Lookout::most_extent_px);
    if (!is_on_) return std::nullopt;
    if (!was_on) {
        lookout_.restart();
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
    const bool everywhere = plain_looks_ == 0 || looks_ % looks_everywhere == 0;
    const Lookout::Sight sight = lookout_.look(own, gyration_px, extent_px, everywhere);
    const double own_z = sight.own_z;
    plain_looks_ = own_z > plain_z && !sight.instead ? plain_looks_ + 1 : 0;
    if (++looks_ < first_looks) return std::nullopt;
    if (clutter.own_share() > plain_share) {
        is_sighted_ = is_confirmed_ = true;
        return std::nullopt;
    }
    if (sight.instead) {
        if (is_confirmed_) hold(own);
        is_sighted_ = true;
        sighted_looks_ = 0;
        return sight.instead;
    }
    is_sighted_ = own_z > (is_sighted_ ? still_here_z : here_z);
    sighted_looks_ = is_sighted_ ? sighted_looks_ + 1 : 0;
    is_confirmed_ |= own_z > confirmed_z || sighted_looks_ > looks_of_chance;
    if (is_sighted_) return std::nullopt;
    if (is_confirmed_) {
        hold(own);
        return std::nullopt;
    }
    // Chance it was.
    held_.t_us = own.t_us;
    return held_;
}

}  // namespace pursuit::tracker
