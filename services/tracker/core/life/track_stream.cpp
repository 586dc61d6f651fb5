// SPDX-License-Identifier: Apache-2.0
// A track from one stream to the next, in this run or from a former one.
#include "services/tracker/core/life/track.hpp"

namespace pursuit::tracker {
namespace {

// A pose older than this is moved on no further: velocities do not hold for ever.
constexpr double longest_way_s = 2;

}  // namespace

void Track::resume(const TrackSnapshot& last, std::uint64_t stream_id) {
    former_ = Former{last, stream_id};
    former_->last.pose = constrained(last.pose, transform_);
}

void Track::begin_stream(std::uint64_t stream_id, std::int64_t first_t_us) {
    if (former_ && is_fresh_) {
        go_on(stream_id, first_t_us);
        return;
    }
    // A start that no event has moved yet was given for the stream that begins.
    if (is_searching_ || is_fresh_) {
        begin(start_, first_t_us);
        return;
    }
    vanishing_.restart();
    silence_.restart();
    is_chased_ = false;
    has_moved_ = false;
    unmoved_until_us_ = 0;
    emerges_ = false;
    emerged_us_ = emerged_at_us_ = -1;
    look_for_blind_us_ = 0;
    if (doubt_.is_open()) begin_doubt(0, start_confirmations, 0);
    outline_.clear();
    tally_.begin_stream();
    acquired_us_ = doubted_us_ = never_us;
    // How long the sensor was away is not known: the last good pose, at rest.
    const Pose last = is_covered_     ? hidden_way_.last().pose
                      : is_acquiring_ ? good_.before().pose
                                      : estimator_->pose();
    is_covered_ = false;
    hidden_way_.restart();
    drift_from(last);
}

// Only what was TRACKING in the very stream that goes on may be told to be TRACKING; all else has
// to be found.
void Track::go_on(std::uint64_t stream_id, std::int64_t first_t_us) {
    const TrackSnapshot& last = former_->last;
    const bool is_same = stream_id == former_->stream_id && first_t_us >= last.t_us;
    const bool is_followed = is_same && last.state == TrackState::tracking;
    const double longest_s = !is_same ? 0 : is_followed ? longest_way_s : tracker_.coast_s;
    const Coast now = Coast{last.t_us, last.pose, last.velocity}.at(first_t_us, longest_s);
    begin({false, now.pose, now.velocity}, first_t_us);
    if (is_followed) return;
    is_fresh_ = false;
    drift_from(now.pose);
    if (is_same && last.state == TrackState::lost) lost_by_ = LossCause::not_seen_again;
}

void Track::drift_from(const Pose& last) {
    good_.set({0, last, {}});
    last_event_t_us_ = placed_us_ = 0;
    lose_grip(0);
    is_adrift_ = true;
    adrift_since_us_ = -1;  // the stream's first time, whatever the sensor counts from
}

}  // namespace pursuit::tracker
