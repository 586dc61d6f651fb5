// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "services/tracker/core/estimator/descent.hpp"
#include "services/tracker/core/estimator/estimator.hpp"
#include "services/tracker/core/estimator/slope.hpp"

namespace pursuit::tracker {

/// Where an event pulls: the paper's nearest model point, or the nearest place of the contour.
enum class Pull { point, contour };

/// The paper's estimator: each event pulls the nearest model point towards itself (descent.hpp).
/// The pose is that after the last event, without prediction; it has no covariance, and its
/// velocity is the slope of the last 20 ms or so.
template <TransformKind kind>
class GradientEstimator : public Estimator {
 public:
    GradientEstimator(const Contour& contour, const ObjectParameters& parameters, Pull pull);

    void restart(const Pose& pose, const Velocity& velocity) override;
    void set_parameters(const ObjectParameters& parameters) override;
    const Approach* approach(const Event& event, const PixelPast& past) override;
    [[nodiscard]] double likelihood() const override;
    bool take(double weight) override;
    [[nodiscard]] double gate_px() const override { return parameters_.gate_px; }
    [[nodiscard]] double reach_px(std::int64_t t_us) const override;
    [[nodiscard]] bool leaps() const override;
    [[nodiscard]] const Pose& pose() const override { return pose_; }
    [[nodiscard]] Velocity velocity() const override;
    void describe(std::int64_t t_us, PoseRecord& record) const override;

 private:
    /// Lookups are as they were for every pose of an isometry.
    static constexpr bool keeps_its_size = kind == TransformKind::isometry;

    void lay_out();
    void measure_extent();
    void sample_slope();
    /// Of a place of the model frame; the nearest of the points, or of the contour.
    template <class Metric>
    const Approach* approach_at(double x, double y, const Metric& metric);
    /// The distance to the contour, and which piece: of those that end at the nearest point. What
    /// is plainly near the point is told for the first of them.
    template <class Metric>
    void look_at_contour(double x, double y, const Metric& metric,
                         const CandidateGrid::Nearest& point);

    Pull pull_;
    Contour contour_;
    ObjectParameters parameters_;
    Pose pose_;
    double extent_px_ = 0;  // of the shape about the pose
    double gate2_px2_ = 0;
    double plainly2_px2_ = 0;  // nearer than this to a point, squared, is near the contour as well
    double reach2_px2_ = 0;    // of the extent and the gate, squared
    DescentGains gains_;
    /// Of x, y, θ (unwrapped), and where the size may change of log sx, log sy.
    using PoseSlope = Slope<keeps_its_size ? 3 : 5>;
    PoseSlope slope_{0.02};
    double turned_rad_ = 0;
    double last_theta_rad_ = 0;
    double residual_px_ = 0.5;

    // What approach() found.
    Eigen::Vector2d q_ = Eigen::Vector2d::Zero();  // the event about T, image; where A may stretch
    Eigen::Vector2d off_ = Eigen::Vector2d::Zero();  // from m to the event, model; where it may not
    Eigen::Vector2d m_ = Eigen::Vector2d::Zero();
    Approach near_;
    std::int64_t t_us_ = 0;
};

std::unique_ptr<Estimator> make_gradient(TransformKind transform, const Contour& contour,
                                         const ObjectParameters& parameters, Pull pull);

}  // namespace pursuit::tracker
