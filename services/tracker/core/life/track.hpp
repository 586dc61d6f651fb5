// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "services/common/event.hpp"
#include "services/tracker/core/estimator/estimator.hpp"
#include "services/tracker/core/geometry/outline.hpp"
#include "services/tracker/core/geometry/reach_map.hpp"
#include "services/tracker/core/geometry/silhouette.hpp"
#include "services/tracker/core/life/acquisition.hpp"
#include "services/tracker/core/life/doubt.hpp"
#include "services/tracker/core/life/good_poses.hpp"
#include "services/tracker/core/life/grip.hpp"
#include "services/tracker/core/life/hidden_way.hpp"
#include "services/tracker/core/life/silence.hpp"
#include "services/tracker/core/life/tally.hpp"
#include "services/tracker/core/life/vanishing.hpp"
#include "services/tracker/core/pixels/recent_pixels.hpp"
#include "services/tracker/core/pose_record.hpp"
#include "services/tracker/core/registration.hpp"
#include "services/tracker/core/search/shape_search.hpp"

namespace pursuit::tracker {

/// One object being followed: its estimator and its life.
///
///     SEARCHING ── a pose is given ──► TRACKING ── events are missing ──► OCCLUDED
///                                          ▲                                   │ coast_s
///                                          └──── acquired again ──── LOST ◄────┘
///
/// While the events match, the estimator has them. When they stop matching, the last good pose
/// coasts on its velocity and the acquisition has the events, from where the coast is, again and
/// again; LOST says that coasting went on too long, or at once that events come as before and do
/// not fit; the acquisition still goes on. No events at all are no mismatch: an object that stands
/// still stays TRACKING, with falling confidence. One that is taken away is LOST: all that it
/// covered changes as it goes.
///
/// An object that other objects cover, all but a fifth of what its motion shows of it, is OCCLUDED:
/// it takes no events and goes on at its velocity of the last second until enough of it shows. Then
/// its events must confirm it within coast_s: until they do it is OCCLUDED still, and after it
/// LOST.
class Track {
 public:
    Track(const RegisteredObject& object, const TrackerParameters& tracker);

    /// Takes new content; the pose goes on.
    void replace(const RegisteredObject& object);
    /// Takes new parameters; everything goes on.
    void set_parameters(const ObjectParameters& parameters, const TrackerParameters& tracker);
    /// Begins anew at the start, and has learnt nothing.
    void restart(const RegisteredObject& object);
    /// A former run followed it, as `last` says, in the stream of this id: the stream that begins
    /// next goes on from there. For a track that no event has moved.
    void resume(const TrackSnapshot& last, std::uint64_t stream_id);
    /// Event time begins anew, at `first_t_us`; the pose is looked for around the last. What a
    /// former run followed in the same stream goes on from where it is by now.
    void begin_stream(std::uint64_t stream_id, std::int64_t first_t_us);

    [[nodiscard]] std::uint32_t object_id() const { return object_id_; }
    [[nodiscard]] Pose pose() const;
    [[nodiscard]] std::uint64_t events_used() const { return events_used_; }

    /// Time goes on: to be called every half ms in which any events come, the object's or not,
    /// from due_us() on.
    void reach_time(std::int64_t t_us, const RecentPixels& pixels);
    /// Later than the next half ms where nothing has stirred the object.
    [[nodiscard]] std::int64_t due_us() const { return due_us_; }
    void stir() { due_us_ = 0; }
    /// Where events until t_us can concern the object.
    [[nodiscard]] Reach reach(std::int64_t t_us) const;
    /// Whether that is to be told after the event taken last.
    [[nodiscard]] bool is_to_be_placed() const {
        return leaps_ || events_used_ % ReachMap::placed_every_events == 0;
    }

    /// How near an event is; null where it is none of the object's. take() uses the event that
    /// approach() was asked for last.
    const Approach* approach(const Event& event, const PixelPast& past);
    /// Of that event under the object, 1/px.
    [[nodiscard]] double likelihood() const {
        return is_acquiring_ ? acquisition_->likelihood() : estimator_->likelihood();
    }
    bool take(const Event& event, double weight);

    /// An event that would have been the object's, were it not hidden there.
    void deny();
    /// Its place is known: what lies on its contour is its own.
    [[nodiscard]] bool is_followed() const { return !is_searching_ && !is_acquiring_; }
    /// This event, whether approach() saw it or not, lies on the contour of another that is
    /// followed.
    void disown(const Event& event) { estimator_->disown(event); }

    // For Seeker.
    /// Where to look for the object, while its place is not known.
    [[nodiscard]] std::optional<SearchRange> wanted(std::int64_t t_us, Geometry geometry) const;
    /// The object may be here: it is tried.
    void offer(std::int64_t t_us, const Pose& pose);
    /// The object was here some time ago: chase() with every event since then finds where it is,
    /// and until end_chase() it takes no others.
    void begin_chase(const Pose& pose);
    void chase(const Event& event);
    /// False where it got lost on the way. Else it is tried.
    bool end_chase(std::int64_t t_us);
    [[nodiscard]] bool is_chased() const { return is_chased_; }
    /// True where the object is to be moved to what was found.
    bool take_finding(std::int64_t t_us, const Doubt::Finding& finding) {
        return doubt_.take(t_us, finding);
    }
    /// So few events come that the object does not move, or nobody sees it.
    [[nodiscard]] bool is_quiet() const { return grip_.health().is_quiet(); }
    /// There were too few events to tell.
    void wait_to_check(std::int64_t t_us);
    /// The object is rather here than where it was thought to be.
    void move_to(std::int64_t t_us, const Pose& pose, const Velocity& velocity);
    [[nodiscard]] const Doubt& doubt() const { return doubt_; }
    [[nodiscard]] const Contour& contour() const { return contour_; }
    [[nodiscard]] bool has_fixed_scale() const { return transform_ == TransformKind::isometry; }
    [[nodiscard]] bool may_stretch() const {
        return transform_ == TransformKind::paper_affine ||
               transform_ == TransformKind::full_affine;
    }

    // For Occlusion, every few ms.
    [[nodiscard]] const Silhouette& silhouette() const { return silhouette_; }
    [[nodiscard]] Outline& outline() { return outline_; }
    [[nodiscard]] const Outline& outline() const { return outline_; }
    [[nodiscard]] double radius_px() const;
    [[nodiscard]] double depth_order() const { return parameters_.depth_order; }
    /// Where it is thought to be and how it goes.
    [[nodiscard]] Coast now(std::int64_t t_us) const { return {t_us, pose(), going().velocity()}; }
    [[nodiscard]] bool can_hide() const;
    [[nodiscard]] bool can_be_hidden() const;
    [[nodiscard]] bool is_partly_hidden() const { return visible_share_ < 1; }
    /// How many events a part of the contour with this arm (image) should have made in the time
    /// that the last tally was over.
    [[nodiscard]] double expected_events(const Outline::Part& part,
                                         const Eigen::Vector2d& arm_px) const {
        return tally_.expected_events(going(), part, arm_px);
    }
    /// Learns how many events the motion makes from what the outline has counted; at once, or when
    /// there is enough of it.
    void tally(std::int64_t t_us, bool at_once);
    /// What the tally was over is done with.
    void end_tally(std::int64_t t_us) {
        if (tally_.t_us() == t_us) outline_.clear();
    }
    /// The outline knows what is hidden.
    void see(std::int64_t t_us);
    /// Nothing is to be taken for hidden any more.
    void show_all(std::int64_t t_us);

    /// What is known at a grid time at or after the last event.
    [[nodiscard]] PoseRecord record(std::int64_t t_us) const;
    /// Notes what the last record told; whether it told of a loss, or of another cause of it.
    bool tells_of_loss(LossCause told) {
        return std::exchange(told_, told) != told && told != LossCause::not_lost;
    }
    /// At the last processed time.
    [[nodiscard]] TrackSnapshot snapshot(std::int64_t t_us) const;

 private:
    /// What a former run knew, and in which stream.
    struct Former {
        TrackSnapshot last;
        std::uint64_t stream_id = 0;
    };

    void make_for(const RegisteredObject& object);
    /// There, at t_us, and nothing is known of how it goes.
    void begin(const Start& start, std::int64_t t_us);
    /// From former_, with a stream.
    void go_on(std::uint64_t stream_id, std::int64_t first_t_us);
    /// It may be anywhere in the stream that begins, near the last pose rather than elsewhere.
    void drift_from(const Pose& last);
    void begin_doubt(std::int64_t t_us, int confirmations, std::int64_t since_us,
                     const std::optional<Coast>& before = std::nullopt);
    /// Whether the object has fallen silent.
    void listen(std::int64_t t_us);
    void doubt_stretch(std::int64_t t_us);
    /// At its start, until it is confirmed; what was found elsewhere since does make events.
    [[nodiscard]] bool is_unseen() const { return doubt_.is_open() && acquired_us_ == never_us; }
    /// Of its contour, in the mean.
    [[nodiscard]] double speed_px_s() const;
    /// What the events counted since the last time, until t_us, say about the pose.
    void weigh(std::int64_t t_us);
    void lose_grip(std::int64_t t_us);
    void run_off(std::int64_t t_us);
    /// To be called when what it depends on has changed.
    void find_what_to_watch();
    /// An event near the object: whether all of it fires at once.
    void watch_inside(const Event& event, std::int64_t since_same_us);
    void acquire(std::int64_t t_us);
    void cover(std::int64_t t_us);
    void uncover(std::int64_t t_us);
    void give_up(std::int64_t t_us);
    [[nodiscard]] Going going() const;
    [[nodiscard]] Pose coasted(std::int64_t t_us) const;
    /// What is known last of where it is; coasting on tells no more.
    [[nodiscard]] Coast known() const;
    /// Of the estimator's pose.
    [[nodiscard]] std::int64_t estimated_us() const {
        return std::max(last_event_t_us_, placed_us_);
    }
    [[nodiscard]] TrackState state_at(std::int64_t t_us) const;
    /// Where its state is lost.
    [[nodiscard]] LossCause loss_cause() const;
    [[nodiscard]] double confidence_at(std::int64_t t_us) const;

    static double seconds(std::int64_t us) { return static_cast<double>(us) * 1e-6; }

    static constexpr std::int64_t never_us = -(std::int64_t{1} << 60);
    // Of its place, before it is believed: at the start, and where it was found.
    static constexpr int start_confirmations = 3;
    static constexpr int found_confirmations = 2;

    std::uint32_t object_id_ = 0;
    std::string name_;
    TransformKind transform_ = TransformKind::isometry;
    ObjectParameters parameters_;
    TrackerParameters tracker_;
    Start start_;                   // as registered
    std::optional<Former> former_;  // holds until an event moves the track
    std::unique_ptr<Estimator> estimator_;
    std::unique_ptr<Acquisition> acquisition_;
    Grip grip_;
    Silence silence_;
    GoodPoses good_;
    Doubt doubt_;
    Contour contour_;
    Outline outline_;
    Silhouette silhouette_;
    Vanishing vanishing_;
    HiddenWay hidden_way_;
    Tally tally_;
    double visible_share_ = 1;
    bool watches_inside_ = false;
    bool leaps_ = false;     // its estimator does
    double sharp2_px2_ = 0;  // nearer than this, squared, an event lies on the contour
    std::int32_t piece_ = -1;
    bool is_covered_ = false;
    bool is_adrift_ = false;  // since a new stream began: it may be anywhere
    std::int64_t adrift_since_us_ = -1;
    bool is_searching_ = false;
    bool is_acquiring_ = false;
    bool is_chased_ = false;             // through events of the past, by its acquisition
    bool is_fresh_ = true;               // since the restart no event was taken
    bool has_moved_ = false;             // by an event since the last weigh()
    std::int64_t near_since_check_ = 0;  // events, since one found too few of them
    std::int64_t unmoved_until_us_ = 0;
    LossCause lost_by_ = LossCause::not_lost;  // not_seen_again once it may coast no more
    LossCause told_ = LossCause::not_lost;
    std::int64_t grip_lost_us_ = 0;
    std::int64_t acquisition_began_us_ = 0;
    std::int64_t trial_until_us_ = -1;  // of an offered pose
    std::int64_t look_for_blind_us_ = 0;
    std::int64_t due_us_ = 0;
    std::int64_t acquired_us_ = never_us;
    std::int64_t doubted_us_ = never_us;  // events spoke against the pose
    std::int64_t emerged_us_ = -1;      // came out from under another; not yet confirmed by events
    bool emerges_ = false;              // and was not checked since
    std::int64_t emerged_at_us_ = -1;   // the last time
    double distance2_px2_ = 0;          // of the event from the contour, squared
    std::int64_t last_event_t_us_ = 0;  // 0: the pose has used none
    std::int64_t placed_us_ = 0;        // the pose was set or moved, by no event
    std::uint64_t events_used_ = 0;
};

}  // namespace pursuit::tracker
