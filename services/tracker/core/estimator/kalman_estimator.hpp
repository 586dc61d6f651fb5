// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/estimator/bend.hpp"
#include "services/tracker/core/estimator/estimator.hpp"
#include "services/tracker/core/estimator/event_clock.hpp"
#include "services/tracker/core/estimator/kalman_parts.hpp"
#include "services/tracker/core/estimator/measurement_noise.hpp"
#include "services/tracker/core/estimator/pace.hpp"
#include "services/tracker/core/estimator/quiet_facings.hpp"
#include "services/tracker/core/estimator/steadiness.hpp"
#include "services/tracker/core/estimator/twist_filter.hpp"
#include "services/tracker/core/leads/backlash.hpp"
#include "services/tracker/core/leads/contour_offsets.hpp"
#include "services/tracker/core/leads/edge_contrast.hpp"
#include "services/tracker/core/leads/edge_polarity.hpp"
#include "services/tracker/core/leads/lead_prior.hpp"
#include "services/tracker/core/leads/pixel_levels.hpp"
#include "services/tracker/core/leads/trail.hpp"
#include "services/tracker/core/noise/clutter.hpp"
#include "services/tracker/core/noise/noise_watch.hpp"

namespace pursuit::tracker {

/// The filter: measures the signed distance of each event along the contour's normal, less the lead
/// that events have on a moving edge (LeadPrior, Backlash, Trail), or beside where it was as the
/// event's pixel was at this level before (PixelLevels). How fast the object can turn
/// away is told by the event clock, by how fast it has gone of late (Pace) and by how steadily it
/// goes (Steadiness), how much of what comes is the object's by the measured clutter. What a full
/// affine transform leaves of a perspective view, a Bend explains.
template <TransformKind kind>
class KalmanEstimator : public Estimator {
 public:
    KalmanEstimator(const Contour& contour, const ObjectParameters& parameters);

    void restart(const Pose& pose, const Velocity& velocity) override;
    void set_parameters(const ObjectParameters& parameters) override;
    void resume(std::int64_t t_us, const Pose& pose, const Velocity& velocity,
                double way_px) override;
    void set_visible_share(double share) override { visible_share_ = share; }
    void set_usual_way(const UsualWay& way) override { usual_way_ = way; }
    void set_blind_us(double blind_us) override {
        lead_prior_.set_blind_us(blind_us);
        levels_.set_blind_us(blind_us);
    }
    void look_about(std::int64_t t_us, const RecentPixels& pixels) override;
    const Approach* approach(const Event& event, const PixelPast& past) override;
    [[nodiscard]] double likelihood() const override {
        return measured_.told.likelihood() * measured_.of_polarity;
    }
    bool take(double weight) override;
    [[nodiscard]] double gate_px() const override {
        return std::min(parameters_.gate_px, Clutter::far_to_px);
    }
    [[nodiscard]] double reach_px(std::int64_t t_us) const override;
    [[nodiscard]] bool is_sudden() const override {
        return watch_.is_on() || clutter_.noise_hz() > NoiseWatch::strong_hz / 2;
    }
    void stand_still() override {
        if (!watch_.is_on()) filter_.slow_down(0);
    }
    void disown(const Event& event) override {
        if (watch_.is_on()) watch_.disown(event);
    }
    [[nodiscard]] bool sees_noise_alone() const override {
        return watch_.helps() ? watch_.is_unseen() : clutter_.is_noise_alone();
    }
    [[nodiscard]] bool may_see_noise_alone() const override {
        return sees_noise_alone() || (!watch_.is_on() && clutter_.can_be_weak_noise());
    }
    [[nodiscard]] bool is_seen_here() const override { return watch_.is_seen_here(); }
    [[nodiscard]] bool stands_out() const override { return watch_.is_sure(); }
    [[nodiscard]] bool is_swamped() const override { return clutter_.is_swamped(); }
    [[nodiscard]] const Pose& pose() const override { return filter_.pose(); }
    [[nodiscard]] Velocity velocity() const override {
        return M::velocity(filter_.twist(), filter_.pose().a);
    }
    void describe(std::int64_t t_us, PoseRecord& record) const override;

 private:
    using Filter = TwistFilter<kind>;
    using M = Motion<kind>;
    using Step = typename M::Step;

    static constexpr bool is_bent = kind == TransformKind::full_affine;
    /// Lookups and areas are as they were for every pose of an isometry.
    static constexpr bool keeps_its_size = kind == TransformKind::isometry;

    /// Lookups are good for so much more than is asked of them.
    static constexpr double lay_out_spare_px = 1;
    static constexpr double usual_pose_sigma_px = 1.2;

    /// Components of a twist of which a UsualWay tells: x, y and the angle, where that is one.
    static constexpr int usual_components = kind == TransformKind::full_affine ? 2 : 3;

    /// The same in x and in y, and in every other component.
    static Step step_of(double place, double about) {
        Step step = Step::Constant(about);
        step.template head<2>().setConstant(place);
        return step;
    }
    void begin_anew();
    void set_speed(double speed_px_s);
    void lay_out();
    void predict_to(std::int64_t t_us);
    /// Of an event q about T, within the object's extent: whether it is beside all of the contour
    /// for sure.
    [[nodiscard]] bool is_far(const Eigen::Vector2d& q, double within_px) const;
    /// How far it may go unheard: on a longer way so many events should have come that it stands.
    void find_silent_way();
    void learn(double r_px, double share);
    /// Corrects by the level that the pixel has crossed as well, where that tells; per_variance:
    /// of the event as such.
    void correct_by_level(double share, double per_variance);
    /// What is half hidden goes as usual, more or less; noise: how it can turn away.
    void go_as_usual(double dt_s, Step& noise);
    /// What the filter knows, dt_s after it was told last.
    void spread(double dt_s);
    /// Whether the levels that pixels cross tell where the edges are, as fast as it goes.
    [[nodiscard]] bool uses_levels() const {
        return parts_.levels && has_leads_ && levels_.tell_at(speed_px_s_);
    }
    /// Of the contour, as the filter has it, in the mean; squared.
    [[nodiscard]] double own_speed2() const {
        return filter_.twist().template head<2>().squaredNorm() +
               M::turning_speed2(filter_.twist(), size_.gyration_px);
    }
    /// Of the variance of a component of a step: its own unit for 1 px of the contour, squared.
    [[nodiscard]] double unit2(int i) const { return i < 2 ? 1 : size_.per_gyration2; }
    /// Among strong noise, every few ms.
    void look_out(std::int64_t t_us);
    void set_out();
    void measure_size();
    /// What is known of the leads besides the events.
    void tell_leads();
    [[nodiscard]] double effective_length_px() const;

    /// How far ahead of the piece an event of this kind comes. (What it says of the leads is taken
    /// for what the event's own lead alone has part in: its contrast changes slowly.)
    [[nodiscard]] double lead_px(std::int32_t piece, int lead) const;

    /// What approach() found, for take().
    struct Measurement {
        typename Filter::Row row;
        double r_px;
        int lead;
        double of_polarity = 1;   ///< Likelihood of the event's polarity.
        double settled_side = 0;  ///< The way its piece goes, ±1; 0 where that is not settled.
        MeasurementNoise::Told told;
        Eigen::Vector2d along_bend;
        double gone = 0;       ///< The way its piece goes, as its lead has it.
        double way_px = 0;     ///< That its edge has gone since its pixel fired, …
        bool has_way = false;  ///< … where that is known.
        bool has_side = false;
        Event event;
        std::int64_t since_us = 0;  ///< Its pixel's last one.
        double place_px = 0;        ///< Of its pixel beside the contour, along the normal.
        Step along;                 ///< d(place)/d(pose), the other way round.
    };

    /// How large the contour is in the image.
    struct Size {
        double length_px = 0;  ///< Of it, 0.6: of one that runs every way, what faces the motion.
        double gyration_px = 0;
        double per_gyration2 = 0;  ///< 1/gyration², 1/px²
        double extent_px = 0;      ///< More than its farthest point is from T.
        double near_px = 0;        ///< Nothing that is near it is farther …
        double watched_px = 0;     ///< … nor what is watched among noise.
    };

    Contour contour_;
    ObjectParameters parameters_;
    KalmanParts parts_;
    bool has_leads_ = true;
    Filter filter_;
    Pace pace_;
    Steadiness<M::dof> steadiness_;
    Size size_;
    EventClock clock_;
    Clutter clutter_;
    Backlash backlash_;
    EdgePolarity edge_polarity_;
    EdgeContrast contrast_;
    Trail trail_;
    MeasurementNoise noise_;
    Bend bend_;
    ContourOffsets offsets_;
    QuietFacings<kind> quiet_;
    PixelLevels levels_;
    NoiseWatch watch_;
    Measurement measured_{};
    Approach near_;
    Pose way_begin_;
    bool stands_still_ = false;  // among noise
    bool has_set_out_ = false;   // what is clutter is known since the restart
    LeadPrior lead_prior_;
    double visible_share_ = 1;
    UsualWay usual_way_;
    double most_pose_sigma_px_ = 0;
    double speed_px_s_ = 0;       // u, when the filter was spread last
    double unspread_s_ = 0;       // since then
    double spread_after_s_ = 0;   // to be again
    double silent_way2_px2_ = 0;  // of it, squared
    double same_edge_us_ = 0;     // a pixel's events of one edge follow each other within
    double residual_px_ = 0.5;
    double sampled_for_area_ = 0;
    std::int64_t t_us_ = -1;  // of the state; -1: before the first event
};

}  // namespace pursuit::tracker
