// SPDX-License-Identifier: Apache-2.0
// A track and what lies over it: how much of it shows, and its way while nothing of it does.
#include "services/tracker/core/life/track.hpp"

namespace pursuit::tracker {
namespace {

// Of what shows of a moving object: below the first it is covered, above the second no more.
constexpr double covered_share = 0.2;
constexpr double uncovered_share = 0.22;

// Of what shows of an object that came out: then it is looked for once more.
constexpr double checked_share = 0.7;

// Longer than this a covered object is not believed to have gone on.
constexpr double longest_covered_s = 4;

}  // namespace

bool Track::can_hide() const {
    return !is_searching_ && !is_acquiring_ && !is_covered_ && !silhouette_.covers_nothing() &&
           grip_.health().is_settled();
}

bool Track::can_be_hidden() const { return is_followed(); }

Going Track::going() const {
    return {pose().a, is_covered_ ? hidden_way_.last().velocity : estimator_->velocity()};
}

void Track::tally(std::int64_t t_us, bool at_once) {
    if (!at_once && !tally_.is_due(t_us)) return;
    tally_.begin(t_us);
    if (is_covered_) {
        hidden_way_.go_on(t_us, tally_.over_s(), transform_);
        return;
    }
    if (is_searching_ || is_acquiring_ || !grip_.health().is_fair()) return;
    // What neither moves nor makes events tells nothing.
    if (!outline_.is_empty() || speed_px_s() > 0) tally_.learn(outline_, going());
    if (visible_share_ >= UsualWay::least_seen_share && hidden_way_.is_due(t_us)) {
        hidden_way_.learn(t_us, pose());
    }
}

void Track::see(std::int64_t t_us) {
    visible_share_ = going().visible_share(outline_, radius_px());
    find_what_to_watch();
    estimator_->set_visible_share(std::max(visible_share_, covered_share));
    estimator_->set_usual_way(hidden_way_.usual());
    // Held by little of its contour it may have slid along what was seen of it; unless the events
    // have fitted ever since.
    if (emerges_ && emerged_us_ < 0 && visible_share_ > checked_share && can_be_hidden()) {
        emerges_ = false;
        if (doubted_us_ >= emerged_at_us_) begin_doubt(t_us, start_confirmations, emerged_at_us_);
    }
    if (!is_covered_ && can_be_hidden() && visible_share_ < covered_share) cover(t_us);
    if (is_covered_ && visible_share_ > uncovered_share) uncover(t_us);
    if (is_covered_ && seconds(t_us - grip_lost_us_) > longest_covered_s) give_up(t_us);
}

void Track::cover(std::int64_t t_us) {
    PoseRecord now;
    estimator_->describe(t_us, now);
    hidden_way_.begin({t_us, now.pose, now.velocity});
    is_covered_ = true;
    vanishing_.restart();
    grip_lost_us_ = t_us;
    grip_.forgive();
}

// It never came out again: it is looked for as one that was lost.
void Track::give_up(std::int64_t t_us) {
    is_covered_ = false;
    emerged_us_ = -1;
    good_.set(hidden_way_.last());
    const std::int64_t covered_since_us = grip_lost_us_;
    lose_grip(t_us);
    grip_lost_us_ = covered_since_us;
}

void Track::show_all(std::int64_t t_us) {
    outline_.show_all();
    if (is_partly_hidden()) see(t_us);
}

void Track::uncover(std::int64_t t_us) {
    stir();
    is_covered_ = false;
    grip_.restart(Health::good);
    const Coast& gone = hidden_way_.last();
    const double way_px =
        seconds(t_us - grip_lost_us_) * std::hypot(gone.velocity.vx_px_s, gone.velocity.vy_px_s);
    emerged_us_ = t_us;
    emerges_ = true;
    emerged_at_us_ = placed_us_ = t_us;
    estimator_->resume(t_us, gone.pose, gone.velocity, way_px);
    good_.set({t_us, gone.pose, gone.velocity});
}

}  // namespace pursuit::tracker
