// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/seeker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/tracker/core/life/where_to_look.hpp"
#include "services/tracker/core/search/lead_on.hpp"

namespace pursuit::tracker {
namespace {

// How often it is asked who wants to be looked for.
constexpr std::int64_t idle_us = 2'000;

// A rest after a search that found nothing, longer from one to the next: the more are made of a
// shape that is not there, the sooner one finds it in something else.
constexpr std::int64_t rest_us = 10'000;
constexpr std::int64_t longest_rest_us = 50'000;

// Poses looked at for each µs of event time, and for an event at most.
constexpr std::int64_t poses_per_us = 40;
constexpr std::int64_t most_poses = 4'000;

// Events a px of contour: of a way of 2 px or so, when the shape is alone.
constexpr double events_per_px = 3;

// Of the noise no more than this share may have the neighbours that an event is to have. (An edge
// that is slow has three or four.) What moves an object by the few events about it is more careful.
constexpr double noise_in_search = 0.3;
constexpr double noise_in_check = 0.1;

// What is quiet may stand in noise, of which that share has such neighbours: more than twice as
// many tell of an edge. (Of edges alone nearly all have them.)
constexpr double least_share_of_edges = 0.25;

// What an object is moved to has to explain what fired there as well, beside scoring higher.
constexpr double explained_weight = 1;

// The second look, at where the shape has gone during the first.
constexpr double again_reach_px = 15;
constexpr double again_angle_rad = 0.4;
constexpr double again_log_scale = 0.1;

}  // namespace

void Seeker::restart(Geometry geometry) {
    geometry_ = geometry;
    last_.restart();
    gathered_.restart(geometry);
    forget_search();
    last_object_id_ = 0;
    attempt_ = 0;
    began_us_ = -1;
    has_looked_ = false;
    in_vain_ = 0;
    due_us_ = 0;
}

void Seeker::go_on(std::int64_t t_us, std::span<Track> tracks, const Occlusion& occlusion) {
    if (object_id_ == 0) {
        begin(t_us, tracks, occlusion);
        return;
    }
    const auto track = std::find_if(tracks.begin(), tracks.end(), [&](const Track& candidate) {
        return candidate.object_id() == object_id_;
    });
    if (is_chasing_ && track != tracks.end() && track->is_chased()) {
        go_on_chasing(t_us, *track);
        return;
    }
    const auto wanted =
        track == tracks.end() || is_chasing_ ? std::nullopt : track->wanted(t_us, geometry_);
    if (!wanted || wanted->is_check != is_check_) {
        forget_search();
        return;
    }
    const std::int64_t poses = std::min((t_us - worked_us_) * poses_per_us, most_poses);
    worked_us_ = t_us;
    search_.step(static_cast<int>(poses));
    if (search_.is_done()) end(t_us, *track);
}

void Seeker::forget_search() {
    object_id_ = 0;
    is_chasing_ = false;
    chase_.stop();
}

void Seeker::begin(std::int64_t t_us, std::span<Track> tracks, const Occlusion& occlusion) {
    due_us_ = t_us + idle_us;
    // By turns: those after the last first.
    Track* chosen = nullptr;
    std::optional<SearchRange> wanted;
    for (int round = 0; round < 2 && chosen == nullptr; ++round) {
        for (Track& track : tracks) {
            if (round == 0 && track.object_id() <= last_object_id_) continue;
            wanted = track.wanted(t_us, geometry_);
            if (!wanted) continue;
            chosen = &track;
            break;
        }
    }
    if (chosen == nullptr) return;
    // All objects are looked for in one way before the next way. As a stream begins, the first way
    // waits for the events that it needs.
    if (began_us_ < 0) began_us_ = t_us;
    const bool waits = !has_looked_ && t_us - began_us_ < looks[0].window_us;
    if (chosen->object_id() <= last_object_id_ && !waits) ++attempt_;
    SearchRange range = *std::move(wanted);
    is_check_ = range.is_check;
    look_ = is_check_ ? looks_of_check[attempt_ % looks_of_check.size()]
                      : looks[attempt_ % looks.size()];
    const std::size_t count = wanted_events(*chosen, look_.times);
    last_object_id_ = chosen->object_id();
    over_.clear();
    if (is_check_) {
        for (const std::size_t k :
             occlusion.over(static_cast<std::size_t>(chosen - tracks.data()))) {
            over_.push_back({tracks[k].silhouette(), tracks[k].now(t_us)});
        }
    }
    gather(t_us, range, chosen->radius_px(), count);
    const std::size_t least = waits ? count : count / 8;
    const bool is_noise =
        is_check_ && chosen->is_quiet() && gathered_.supported_share() < least_share_of_edges;
    if (is_noise || gathered_.events().size() < (is_check_ ? wanted_events(*chosen, 0.2) : least)) {
        if (is_check_) chosen->wait_to_check(t_us);
        return;
    }
    has_looked_ = true;
    going_ = range.going;
    checked_ = own_ = range.checked;
    if (is_check_ && !going_) {
        checked_ = checked_.at(t_us - static_cast<std::int64_t>(gathered_.mean_age_us(t_us)), 1);
        const double back_rad = theta_rad(checked_.pose.a) - theta_rad(range.checked.pose.a);
        range.around = {checked_.pose.t_px, rotation(back_rad) * range.around.a};
        range.seeds.front() = checked_.pose;
    }
    if (is_check_ && chosen->may_stretch()) {
        range.stretched = stretched_poses(chosen->contour(), checked_.pose);
    }
    if (going_) lead_on(gathered_.events(), t_us, *going_, geometry_);
    if (!is_check_) {
        chase_.begin(last_, t_us - static_cast<std::int64_t>(gathered_.mean_age_us(t_us)));
    }
    map_.build(geometry_, gathered_.events());
    search_ = is_check_ ? ShapeSearch(chosen->contour(), chosen->outline())
                        : ShapeSearch(chosen->contour());
    search_.begin(map_, range);
    object_id_ = chosen->object_id();
    worked_us_ = t_us;
    due_us_ = t_us;
}

std::size_t Seeker::wanted_events(const Track& track, double times) {
    const double scale = track.radius_px() / std::max(track.contour().radius_px(), 1e-9);
    const double once = events_per_px * track.contour().length_px() * scale;
    return std::clamp(static_cast<std::size_t>(once * times), std::size_t{100}, LastEvents::most);
}

void Seeker::end(std::int64_t t_us, Track& track) {
    due_us_ = t_us + idle_us;
    if (is_check_) {
        forget_search();
        end_check(t_us, track);
        return;
    }
    if (!search_.found()) {
        forget_search();
        due_us_ = t_us + std::min(++in_vain_ * rest_us, longest_rest_us);
        return;
    }
    in_vain_ = 0;
    if (!chase_.is_complete()) {
        forget_search();
        find_nearby(t_us, track);
        return;
    }
    is_chasing_ = true;
    track.begin_chase(search_.found()->pose);
    due_us_ = t_us;
}

// From where it was when the search began, through what came since.
void Seeker::go_on_chasing(std::int64_t t_us, Track& track) {
    chase_.go_on([&](const Event& event) { track.chase(event); });
    if (!chase_.is_caught_up() && chase_.is_complete()) return;
    forget_search();
    due_us_ = t_us + idle_us;
    if (!track.end_chase(t_us)) find_nearby(t_us, track);
}

// What does not go fast is near to where it was.
void Seeker::find_nearby(std::int64_t t_us, Track& track) {
    SearchRange again;
    again.around = search_.found()->pose;
    look_again(t_us, track, std::move(again));
    if (search_.found()) track.offer(t_us, search_.found()->pose);
}

// Whether the object is where it is thought to be, or rather elsewhere.
void Seeker::end_check(std::int64_t t_us, Track& track) {
    Doubt::Finding finding =
        compare(track.contour(), search_.found(), checked_.pose, search_.score_of(checked_.pose));
    if (finding.is_told && !finding.is_here) {
        const double more =
            search_.explained(search_.found()->pose) - search_.explained(checked_.pose);
        finding.gain += explained_weight * more;
        // A short one lies on some edges the more easily, and leaves others to nobody.
        if (track.may_stretch() && more < 0) finding.is_told = finding.is_sure = false;
        if (!going_) finding.gain -= more_as_it_goes();
    }
    if (!track.take_finding(t_us, finding)) return;
    // Where it has gone meanwhile, if it goes so.
    Coast found{checked_.t_us, search_.found()->pose, checked_.velocity};
    if (going_) found.velocity = going_->at(checked_.t_us, 1).velocity;
    if (going_ || !finding.is_sure) found = found.at(t_us, 1);
    if (finding.is_sure) {
        SearchRange again;
        again.around = found.pose;
        again.since_us = track.doubt().since_us();
        if (going_) again.going = found;
        look_again(t_us, track, std::move(again));
        if (search_.found()) found.pose = search_.found()->pose;
        if (!going_) found.velocity = {};
    }
    track.move_to(t_us, found.pose, found.velocity);
}

// An object smears its own events as it goes, so that it stands out less where it is than some
// place half behind it: how much more speaks for it in the same events led on.
double Seeker::more_as_it_goes() {
    const auto worth = [&](const Pose& pose) {
        return search_.score_of(pose) + explained_weight * search_.explained(pose);
    };
    const double standing = worth(checked_.pose);
    lead_on(gathered_.events(), own_.t_us, own_, geometry_);
    map_.build(geometry_, gathered_.events());
    return std::max(worth(own_.pose) - standing, 0.0);
}

void Seeker::look_again(std::int64_t t_us, const Track& track, SearchRange again) {
    again.reach_px = again.usual_distance_px = again_reach_px;
    again.angle_rad = again_angle_rad;
    again.log_scale = track.has_fixed_scale() || is_check_ ? 0 : again_log_scale;
    gather(t_us, again, track.radius_px(),
           static_cast<std::size_t>(events_per_px * track.contour().length_px()));
    if (again.going) lead_on(gathered_.events(), t_us, *again.going, geometry_);
    map_.build(geometry_, gathered_.events());
    search_.begin(map_, again);
    search_.step(1 << 30);
}

void Seeker::gather(std::int64_t t_us, const SearchRange& range, double radius_px,
                    std::size_t count) {
    SupportedEvents::Wish wish;
    wish.around_px = range.around.t_px;
    wish.reach_px = range.reach_px + radius_px + 8;
    wish.since_us = std::max(t_us - look_.window_us, range.since_us);
    wish.neighbour_us = look_.neighbour_us;
    wish.noise_share = is_check_ ? noise_in_check : noise_in_search;
    wish.most = count;
    gathered_.gather(t_us, last_, wish, over_);
}

}  // namespace pursuit::tracker
