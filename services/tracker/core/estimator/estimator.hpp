// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>

#include "services/common/event.hpp"
#include "services/tracker/core/estimator/usual_way.hpp"
#include "services/tracker/core/geometry/contour.hpp"
#include "services/tracker/core/pixels/pixel_past.hpp"
#include "services/tracker/core/pixels/recent_pixels.hpp"
#include "services/tracker/core/pose_record.hpp"
#include "services/tracker/core/registration.hpp"

namespace pursuit::tracker {

/// How near an event is to an object that it may belong to.
struct Approach {
    double distance2_px2 = 0;  ///< To what the event pulls, squared.
    double clutter = 0;        ///< Density of events that are no object's, 1/px.
    /// Whether take() weighs the event against the clutter by itself.
    bool is_weighed = false;

    /// To the contour, squared, and which piece of it; where points pull, at most so far, and of
    /// the pieces that end at the point.
    double contour2_px2 = 0;
    std::int32_t piece = -1;

    [[nodiscard]] double distance_px() const { return std::sqrt(distance2_px2); }
};

/// Moves one object's pose by its events. Both ideas, the paper's gradient and the filter, are one
/// of these. approach() asks how near an event is; take() moves the pose by the event that was
/// asked for last. Between the two nothing else is called.
class Estimator {
 public:
    virtual ~Estimator() = default;

    /// Begins anew at a pose; `sure` where it is known to a px or so.
    virtual void restart(const Pose& pose, const Velocity& velocity) = 0;
    virtual void set_parameters(const ObjectParameters& parameters) = 0;

    /// Goes on where the object went unseen for way_px: along the way it is known to a few percent
    /// of it, across the way, and in angle and scale, to a px.
    virtual void resume(std::int64_t t_us, const Pose& pose, const Velocity& velocity,
                        double way_px) {
        static_cast<void>(t_us);
        static_cast<void>(way_px);
        restart(pose, velocity);
    }
    /// How much of what the object's motion would show is not hidden, above 0 … 1.
    virtual void set_visible_share(double share) { static_cast<void>(share); }
    /// How it goes as a rule: what is half hidden goes on so.
    virtual void set_usual_way(const UsualWay& way) { static_cast<void>(way); }

    /// How long a pixel of the sensor is blind after an event, as far as is known.
    virtual void set_blind_us(double blind_us) { static_cast<void>(blind_us); }

    /// How the pixels about the object fired lately, every ms or so.
    virtual void look_about(std::int64_t t_us, const RecentPixels& pixels) {
        static_cast<void>(t_us);
        static_cast<void>(pixels);
    }

    /// The event's distance to the model in the image; null beyond the gate. Holds until the next.
    virtual const Approach* approach(const Event& event, const PixelPast& past) = 0;

    /// Of that event under the object, 1/px.
    [[nodiscard]] virtual double likelihood() const = 0;

    /// Uses the event with a weight 0 … 1; false where it came to nothing.
    virtual bool take(double weight) = 0;

    /// This event lies on another object's contour; it may not have been asked for.
    virtual void disown(const Event& event) { static_cast<void>(event); }

    /// Farther than this from the contour no event is the object's, px.
    [[nodiscard]] virtual double gate_px() const = 0;
    /// How far from the pose's place an event until t_us can be and concern the object, px.
    [[nodiscard]] virtual double reach_px(std::int64_t t_us) const = 0;
    /// Whether a few events may move the pose by more than ReachMap has room for.
    [[nodiscard]] virtual bool leaps() const { return false; }
    /// Whether any event may make the reach more, or put the pose elsewhere.
    [[nodiscard]] virtual bool is_sudden() const { return false; }

    /// It does not move any more, until events tell that it does.
    virtual void stand_still() {}
    /// Whether what comes near the object is noise alone: it makes no events of its own.
    [[nodiscard]] virtual bool sees_noise_alone() const { return false; }
    /// Whether what comes may as well be noise, of which there is little: of an object whose place
    /// was not yet confirmed it says nothing then.
    [[nodiscard]] virtual bool may_see_noise_alone() const { return false; }
    /// Whether among strong noise the object shows where it is thought to be, plainly or not, and
    /// nothing nearby does better.
    [[nodiscard]] virtual bool is_seen_here() const { return false; }
    /// Whether among strong noise the object was looked for nearby and plainly is where it is
    /// thought to be.
    [[nodiscard]] virtual bool stands_out() const { return false; }
    /// Whether there is so much noise that nothing can be followed in it.
    [[nodiscard]] virtual bool is_swamped() const { return false; }

    [[nodiscard]] virtual const Pose& pose() const = 0;
    [[nodiscard]] virtual Velocity velocity() const = 0;

    /// Fills in pose, velocity, covariances, residual and rate at a time after the last event.
    virtual void describe(std::int64_t t_us, PoseRecord& record) const = 0;
};

std::unique_ptr<Estimator> make_estimator(EstimatorKind kind, TransformKind transform,
                                          const Shape& shape, const ObjectParameters& parameters);

}  // namespace pursuit::tracker
