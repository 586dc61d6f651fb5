// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/track.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/tracker/core/life/blind_parts.hpp"

namespace pursuit::tracker {
namespace {

// How often the acquisition begins again at the coasted pose.
constexpr std::int64_t acquisition_us = 150'000;

constexpr std::int64_t look_for_blind_every_us = 2'000;

// Time goes on in larger steps where nothing happens to the object.
constexpr std::int64_t unstirred_us = 2'000;

}  // namespace

Track::Track(const RegisteredObject& object, const TrackerParameters& tracker) : tracker_(tracker) {
    make_for(object);
    start_ = object.start;
    begin(start_, object.effective_time_us);
}

void Track::make_for(const RegisteredObject& object) {
    object_id_ = object.object_id;
    name_ = object.shape.name;
    transform_ = object.transform;
    parameters_ = object.parameters;
    estimator_ =
        make_estimator(object.estimator, object.transform, object.shape, object.parameters);
    acquisition_ = std::make_unique<Acquisition>(object);
    contour_ = Contour(object.shape);
    grip_.hold(contour_);
    outline_ = Outline(contour_);
    silhouette_ = Silhouette(contour_);
    vanishing_ = Vanishing(silhouette_, contour_.radius_px());
    find_what_to_watch();
}

void Track::replace(const RegisteredObject& object) {
    const PoseRecord last = record(estimated_us());
    make_for(object);
    start_ = object.start;  // as the new transform allows it
    if (former_) former_->last.pose = constrained(former_->last.pose, transform_);
    is_chased_ = false;
    estimator_->restart(constrained(last.pose, transform_), last.velocity);
    hidden_way_.constrain(transform_);
    if (is_acquiring_) acquisition_->begin(constrained(last.pose, transform_));
    good_.constrain(transform_);
}

void Track::set_parameters(const ObjectParameters& parameters, const TrackerParameters& tracker) {
    parameters_ = parameters;
    tracker_ = tracker;
    if (tracker.checks_pose < 0.5) doubt_.settle();
    estimator_->set_parameters(parameters);
    find_what_to_watch();
}

void Track::restart(const RegisteredObject& object) {
    if (events_used_ > 0) make_for(object);
    start_ = object.start;
    former_.reset();
    begin(start_, object.effective_time_us);
}

void Track::begin(const Start& start, std::int64_t t_us) {
    stir();
    last_event_t_us_ = 0;
    placed_us_ = t_us;
    is_searching_ = start.search;
    is_fresh_ = true;
    is_acquiring_ = is_covered_ = is_chased_ = is_adrift_ = has_moved_ = false;
    near_since_check_ = 0;
    unmoved_until_us_ = 0;
    silence_.restart();
    emerges_ = false;
    emerged_us_ = emerged_at_us_ = -1;
    look_for_blind_us_ = 0;
    acquired_us_ = doubted_us_ = never_us;
    trial_until_us_ = -1;
    visible_share_ = 1;
    vanishing_.restart();
    find_what_to_watch();
    outline_.clear();
    outline_.show_all();
    outline_.fade_blind(0);
    tally_.restart();
    hidden_way_.restart();
    begin_doubt(0, start_confirmations, 0);
    grip_.restart();
    estimator_->restart(start.pose, start.velocity);
    good_.begin_at(start.pose, start.velocity);
}

void Track::lose_grip(std::int64_t t_us) {
    stir();
    is_acquiring_ = true;
    lost_by_ = LossCause::not_lost;
    grip_.forgive();
    grip_lost_us_ = t_us;
    good_.coast_from(t_us);
    acquisition_began_us_ = t_us;
    trial_until_us_ = -1;
    acquisition_->begin(coasted(t_us));
}

// What its events made of it is no pose: the last good one is all that is known.
void Track::run_off(std::int64_t t_us) {
    estimator_->restart(good_.before().pose, {});
    lose_grip(t_us);
    lost_by_ = LossCause::out_of_bounds;
}

void Track::weigh(std::int64_t t_us) {
    const bool is_noise =
        is_unseen() ? estimator_->may_see_noise_alone() : estimator_->sees_noise_alone();
    const bool says_nothing = is_noise || grip_.health().is_quiet();
    vanishing_.count_own(t_us, grip_.sharp(), grip_.astray(),
                         says_nothing ? 0 : grip_.health().usual_sharpness());
    grip_.weigh(t_us, is_noise, estimator_->is_seen_here(), parameters_.let_go_sharpness);
    if (grip_.is_against()) doubted_us_ = t_us;
    const Health& health = grip_.health();
    if (parameters_.let_go_sharpness > 0 && grip_.is_lost()) {
        lose_grip(t_us);
        if (!health.is_as_usual()) lost_by_ = LossCause::does_not_fit;
        return;
    }
    if (health.is_settled() && health.is_fair()) emerged_us_ = -1;
    if (doubt_.is_open() && estimator_->stands_out()) doubt_.settle();
    const bool is_good = health.is_fair() && !health.is_quiet() && !grip_.is_against();
    if (has_moved_ && good_.is_due(t_us) && is_good && !doubt_.is_open()) {
        PoseRecord now;
        now.t_us = t_us;
        estimator_->describe(t_us, now);
        good_.add(now);
    }
    has_moved_ = false;
}

void Track::acquire(std::int64_t t_us) {
    // What was found a moment after all of it had changed has yet to show that it is there.
    if (!vanishing_.is_suspected()) vanishing_.restart();
    const bool was_anywhere = is_adrift_ || is_searching_;
    is_acquiring_ = false;
    is_searching_ = false;
    is_adrift_ = false;
    trial_until_us_ = -1;
    acquired_us_ = t_us;
    emerged_us_ = -1;
    grip_.restart(Health::good);
    estimator_->restart(acquisition_->pose(), acquisition_->velocity());
    good_.set({t_us, acquisition_->pose(), acquisition_->velocity()});
    hidden_way_.learn_anew();
    silence_.hear(t_us);
    begin_doubt(t_us, found_confirmations, t_us);
    if (was_anywhere) doubt_.leave_angle_open();
}

Pose Track::coasted(std::int64_t t_us) const {
    return good_.before().at(t_us, tracker_.coast_s).pose;
}

void Track::listen(std::int64_t t_us) {
    const double usual_hz = grip_.health().usual_rate_hz();
    if (emerged_us_ >= 0 || !silence_.is_silent(t_us, usual_hz)) return;
    if (!silence_.begins(t_us, usual_hz, speed_px_s())) return;
    const Coast before{silence_.heard_us(), estimator_->pose(), estimator_->velocity()};
    begin_doubt(t_us, found_confirmations, t_us, before);
}

// Stretched along its own lines, a shape goes on to fit in part, and its ends make no events.
void Track::doubt_stretch(std::int64_t t_us) {
    if (!may_stretch() || !grip_.is_patchy(t_us)) return;
    if (!doubt_.is_open() && !is_partly_hidden()) begin_doubt(t_us, found_confirmations, 0);
}

Pose Track::pose() const {
    if (is_covered_) return hidden_way_.last().pose;
    return is_acquiring_ ? acquisition_->pose() : estimator_->pose();
}

void Track::reach_time(std::int64_t t_us, const RecentPixels& pixels) {
    due_us_ = due_us_ == 0 ? t_us : t_us + unstirred_us;
    leaps_ = estimator_->leaps();  // the farther the larger it is
    estimator_->set_blind_us(pixels.blind_us());
    if (adrift_since_us_ < 0) {
        adrift_since_us_ = t_us;
        if (is_adrift_) grip_lost_us_ = t_us;
    }
    if (is_covered_) return;
    if (!is_acquiring_ && !is_sound(estimator_->pose(), transform_)) run_off(t_us);
    if (!is_acquiring_ && grip_.is_counting()) weigh(silence_.heard_us());
    if (!is_acquiring_) {
        if (t_us >= look_for_blind_us_) {
            look_for_blind_us_ = t_us + look_for_blind_every_us;
            look_for_blind_parts(t_us, estimator_->pose(), estimator_->velocity(), radius_px(),
                                 pixels, outline_);
        }
        if (grip_.is_due_to_look(t_us)) {
            grip_.look_around(t_us, outline_, estimator_->pose(), estimator_->velocity());
            doubt_stretch(t_us);
        }
        estimator_->look_about(t_us, pixels);
    }
    if (vanishing_.is_gone(t_us)) {
        if (!is_acquiring_) lose_grip(t_us);
        lost_by_ = LossCause::gone;
        emerged_us_ = -1;
        vanishing_.restart();
    }
    if (emerged_us_ >= 0 && seconds(t_us - emerged_us_) > tracker_.coast_s) give_up(t_us);
    if (t_us < trial_until_us_ || is_chased_) return;
    if (is_searching_) is_acquiring_ = false;
    if (!is_acquiring_ && !is_searching_) listen(t_us);
    const bool is_coasting = seconds(t_us - grip_lost_us_) < tracker_.coast_s;
    if (is_acquiring_ && is_coasting && t_us - acquisition_began_us_ > acquisition_us) {
        acquisition_began_us_ = t_us;
        acquisition_->begin(coasted(t_us));
    }
}

Reach Track::reach(std::int64_t t_us) const {
    if (is_covered_ || is_chased_ || (is_searching_ && !is_acquiring_)) return {};
    if (is_acquiring_) return {acquisition_->pose().t_px, acquisition_->reach_px(t_us), false};
    const Pose& pose = estimator_->pose();
    double reach_px = estimator_->reach_px(t_us);
    if (watches_inside_) {
        const double scale = has_fixed_scale() ? 1 : largest_scale(pose.a);
        reach_px = std::max(reach_px, vanishing_.reach_px() * scale);
    }
    return {pose.t_px, reach_px, estimator_->is_sudden()};
}

const Approach* Track::approach(const Event& event, const PixelPast& past) {
    if (is_covered_ || is_chased_ || (is_searching_ && !is_acquiring_)) return nullptr;
    if (is_acquiring_) return acquisition_->approach(event);
    const Approach* const near = estimator_->approach(event, past);
    constexpr double nearest2_px2 = Vanishing::nearest_px * Vanishing::nearest_px;
    if (watches_inside_ && (near == nullptr || near->contour2_px2 >= nearest2_px2)) {
        watch_inside(event, past.since_same_us);
    }
    if (near != nullptr) {
        distance2_px2_ = near->contour2_px2;
        piece_ = near->piece;
    }
    return near;
}

void Track::find_what_to_watch() {
    sharp2_px2_ = estimator_->gate_px() * estimator_->gate_px() / 16;
    // Where another covers it in part, what comes from inside may be the other's.
    watches_inside_ =
        vanishing_.can_tell() && !is_partly_hidden() && parameters_.let_go_sharpness > 0;
}

void Track::watch_inside(const Event& event, std::int64_t since_same_us) {
    vanishing_.see(event, estimator_->pose(), since_same_us);
    if (vanishing_.is_suspected()) doubted_us_ = event.t_us;
}

bool Track::take(const Event& event, double weight) {
    is_fresh_ = false;
    stir();
    ++near_since_check_;
    if (is_acquiring_) {
        acquisition_->take();
        if (acquisition_->is_done()) acquire(event.t_us);
    } else {
        // After a pause the next one says by itself whether it is quiet.
        const bool was_pause = silence_.hear(event.t_us);
        const bool is_sharp = distance2_px2_ < sharp2_px2_;
        grip_.count(is_sharp);
        if (was_pause || grip_.is_due()) {
            weigh(event.t_us);
            if (is_acquiring_) return false;
        }
        // What is left in a quiet time is mostly noise: it does not move the pose.
        if (grip_.health().is_quiet()) {
            estimator_->stand_still();
            return false;
        }
        if (!estimator_->take(weight)) return false;
        has_moved_ = true;
        if (is_sharp && piece_ >= 0) {
            grip_.count_place(piece_);
            outline_.count(piece_, weight);
        }
    }
    last_event_t_us_ = event.t_us;
    ++events_used_;
    return true;
}

void Track::deny() {
    // Counted like those taken: enough of them, and the object is not hidden there.
    if (!is_acquiring_ && piece_ >= 0 && distance2_px2_ < sharp2_px2_) {
        outline_.count(piece_, 1);
    }
}

double Track::speed_px_s() const {
    const Velocity v = estimator_->velocity();
    return std::hypot(v.vx_px_s, v.vy_px_s, v.omega_rad_s * contour_.gyration_px());
}

double Track::radius_px() const { return contour_.radius_px() * pose().a.norm(); }

}  // namespace pursuit::tracker
