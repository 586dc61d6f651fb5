// SPDX-License-Identifier: Apache-2.0
// What a track tells of itself: its state, how far it is to be believed, pose and snapshot.
#include <algorithm>
#include <cmath>

#include "services/tracker/core/life/track.hpp"

namespace pursuit::tracker {
namespace {

// What is silent may have gone so far meanwhile.
constexpr double unseen_way_px = 5;

constexpr std::int64_t believed_after_us = 100'000;

// In silence nothing tells that the object is still there.
constexpr double sure_s = 0.1;
constexpr double doubt_s = 0.3;

}  // namespace

TrackState Track::state_at(std::int64_t t_us) const {
    if (is_searching_) return TrackState::searching;
    if (!is_acquiring_ && !is_covered_ && estimator_->is_swamped()) return TrackState::lost;
    if (is_covered_ || (emerged_us_ >= 0 && !is_acquiring_)) return TrackState::occluded;
    if (vanishing_.is_gone(t_us)) return TrackState::lost;
    if (!is_acquiring_) return TrackState::tracking;
    // Hidden by what is not tracked, its events are missing; what does not fit is something else.
    if (lost_by_ != LossCause::not_lost) return TrackState::lost;
    return seconds(t_us - grip_lost_us_) < tracker_.coast_s ? TrackState::occluded
                                                            : TrackState::lost;
}

LossCause Track::loss_cause() const {
    if (!is_acquiring_) return estimator_->is_swamped() ? LossCause::in_noise : LossCause::gone;
    return lost_by_ != LossCause::not_lost ? lost_by_ : LossCause::not_seen_again;
}

double Track::confidence_at(std::int64_t t_us) const {
    if (is_searching_ || is_acquiring_ || is_covered_ || emerged_us_ >= 0) return 0;
    if (estimator_->is_swamped() || vanishing_.is_suspected()) return 0;
    const double fit = grip_.fit();
    const double silent_s = seconds(t_us - grip_.health().lively_t_us()) - sure_s;
    const double believed = silent_s > 0 ? fit * std::exp(-silent_s / doubt_s) : fit;
    // What was found again, or did not fit, is believed when it has fitted for a while; what is
    // silent may have gone on meanwhile.
    const bool is_doubted =
        t_us - std::max(acquired_us_, doubted_us_) < believed_after_us || doubt_.is_open();
    const bool may_be_gone = silence_.is_silent(t_us, grip_.health().usual_rate_hz()) &&
                             silence_.lasts_s(t_us) * speed_px_s() > unseen_way_px;
    return is_doubted || may_be_gone ? std::min(believed, 0.5) : believed;
}

PoseRecord Track::record(std::int64_t t_us) const {
    PoseRecord record;
    record.object_id = object_id_;
    record.t_us = t_us;
    record.last_event_t_us = last_event_t_us_;
    record.model = name_;
    record.transform = transform_;
    record.state = state_at(t_us);
    if (record.state == TrackState::lost) record.loss_cause = loss_cause();
    estimator_->describe(t_us, record);
    if (is_acquiring_ && !is_searching_) {
        record.pose = coasted(t_us);
        record.velocity = good_.before().velocity;
    }
    if (is_covered_) {
        record.pose = hidden_way_.pose_at(t_us);
        record.velocity = hidden_way_.last().velocity;
    }
    record.confidence = static_cast<float>(confidence_at(t_us));
    if (!check(record.pose, transform_) || !check(record.velocity)) {
        // Found out before the track is told (run_off()).
        record.pose = good_.before().pose;
        record.velocity = {};
        record.state = TrackState::lost;
        record.loss_cause = LossCause::out_of_bounds;
        record.confidence = 0;
    }
    record.theta_rad = theta_rad(record.pose.a);
    record.scale_x = scale_x(record.pose.a);
    record.scale_y = scale_y(record.pose.a);
    record.events_used = events_used_;
    if (!is_searching_ && !is_acquiring_ && !is_covered_) {
        record.event_rate_hz = static_cast<float>(grip_.health().rate_hz(t_us));
    }
    return record;
}

Coast Track::known() const {
    if (is_covered_) return hidden_way_.last();
    if (is_acquiring_) return good_.before();
    PoseRecord now;
    estimator_->describe(estimated_us(), now);
    return {estimated_us(), now.pose, now.velocity};
}

TrackSnapshot Track::snapshot(std::int64_t t_us) const {
    if (former_ && is_fresh_) return former_->last;
    TrackSnapshot snapshot;
    snapshot.object_id = object_id_;
    snapshot.state = state_at(std::max(t_us, estimated_us()));
    snapshot.was_tracked = !is_searching_ && (events_used_ > 0 || is_adrift_);
    const Coast last = known();
    snapshot.t_us = last.t_us;
    snapshot.pose = last.pose;
    snapshot.velocity = last.velocity;
    return snapshot;
}

}  // namespace pursuit::tracker
