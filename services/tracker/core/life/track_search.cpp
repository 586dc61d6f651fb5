// SPDX-License-Identifier: Apache-2.0
// A track and the searches for it: what it asks of Seeker, and what it makes of a finding.
#include "services/tracker/core/life/track.hpp"
#include "services/tracker/core/life/where_to_look.hpp"

namespace pursuit::tracker {
namespace {

// An offered pose that the events do not confirm in this time is none; one is asked for when the
// acquisition has not found the object by itself in the other.
constexpr std::int64_t trial_us = 80'000;
constexpr std::int64_t unaided_us = 30'000;
constexpr double trial_gate_px = 6;

// Where a check found too few events, the next one waits until so many came near the object, or for
// so long: many objects that nothing moves shall not keep the searches busy.
constexpr int worth_a_check = 16;
constexpr std::int64_t unmoved_us = 500'000;

}  // namespace

std::optional<SearchRange> Track::wanted(std::int64_t t_us, Geometry geometry) const {
    if (t_us < trial_until_us_) return std::nullopt;
    if (!is_searching_ && !is_acquiring_) {
        if (!doubt_.is_due(t_us)) return std::nullopt;
        if (near_since_check_ < worth_a_check && t_us < unmoved_until_us_) return std::nullopt;
        // What was not seen yet and is quiet may make its events elsewhere.
        const bool is_lively = !grip_.health().is_quiet() || is_unseen();
        const bool is_told =
            !is_covered_ && emerged_us_ < 0 && is_lively && !estimator_->sees_noise_alone();
        if (!is_told) return std::nullopt;
        return range_of_check(t_us, {t_us, pose(), estimator_->velocity()}, doubt_,
                              good_.before().pose, tracker_.coast_s);
    }
    if (is_searching_) return range_of_image(estimator_->pose(), geometry, has_fixed_scale());
    if (t_us - grip_lost_us_ < unaided_us) return std::nullopt;
    const Coast& good = good_.before();
    if (is_adrift_) {
        const double adrift_s = adrift_since_us_ < 0 ? 0 : seconds(t_us - adrift_since_us_);
        return range_adrift(good.pose, adrift_s, geometry, has_fixed_scale());
    }
    const double gap_s = seconds(t_us - good.t_us);
    if (gap_s >= tracker_.coast_s) return range_of_image(good.pose, geometry, has_fixed_scale());
    return range_near(good.at(t_us, tracker_.coast_s), gap_s, has_fixed_scale());
}

void Track::offer(std::int64_t t_us, const Pose& pose) {
    stir();
    is_acquiring_ = true;
    trial_until_us_ = t_us + trial_us;
    acquisition_began_us_ = t_us;
    acquisition_->begin(constrained(pose, transform_), trial_gate_px);
}

void Track::begin_chase(const Pose& pose) {
    is_chased_ = true;
    acquisition_->begin(constrained(pose, transform_), trial_gate_px);
}

void Track::chase(const Event& event) {
    if (acquisition_->approach(event) != nullptr) acquisition_->take();
}

bool Track::end_chase(std::int64_t t_us) {
    stir();  // it takes events again
    is_chased_ = false;
    const bool is_here = acquisition_->is_done();
    if (is_here) {
        is_acquiring_ = true;
        trial_until_us_ = t_us + trial_us;
        acquisition_began_us_ = t_us;
    } else if (is_acquiring_) {
        acquisition_->begin(coasted(t_us));
    }
    return is_here;
}

void Track::move_to(std::int64_t t_us, const Pose& pose, const Velocity& velocity) {
    stir();
    const Pose moved = constrained(pose, transform_);
    grip_.restart(Health::good);
    acquired_us_ = placed_us_ = t_us;
    if (doubt_.since_us() == emerged_at_us_) {
        // It goes on as it did before it was hidden.
        estimator_->resume(t_us, moved, hidden_way_.last().velocity, 0);
    } else {
        estimator_->restart(moved, velocity);
    }
    good_.set({t_us, moved, velocity});
    hidden_way_.learn_anew();
    vanishing_.restart();
    // What came before the move is of the same object.
    if (tracker_.checks_pose >= 0.5) doubt_.begin_again(t_us, found_confirmations);
}

void Track::begin_doubt(std::int64_t t_us, int confirmations, std::int64_t since_us,
                        const std::optional<Coast>& before) {
    if (tracker_.checks_pose >= 0.5) doubt_.begin(t_us, confirmations, since_us, before);
}

void Track::wait_to_check(std::int64_t t_us) {
    doubt_.wait(t_us);
    if (near_since_check_ < worth_a_check) unmoved_until_us_ = t_us + unmoved_us;
    near_since_check_ = 0;
}

}  // namespace pursuit::tracker
