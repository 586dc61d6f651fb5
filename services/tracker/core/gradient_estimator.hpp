// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/descent.hpp"
#include "services/tracker/core/estimator.hpp"
#include "services/tracker/core/slope.hpp"

namespace pursuit::tracker {

/// The paper's estimator: each event pulls the nearest model point towards itself (descent.hpp).
/// The pose is that after the last event, without prediction; it has no covariance, and its
/// velocity is the slope of the last 20 ms or so.
class GradientEstimator : public Estimator {
 public:
    /// Where the event pulls: the paper's nearest model point, or the nearest place of the contour.
    enum class Pull { point, contour };

    GradientEstimator(TransformKind transform, const Contour& contour,
                      const ObjectParameters& parameters, Pull pull = Pull::point);

    void restart(const Pose& pose, const Velocity& velocity) override;
    void set_parameters(const ObjectParameters& parameters) override;
    Approach approach(const Event& event, const PixelPast& past) override;
    [[nodiscard]] double likelihood() const override;
    bool take(double weight) override;
    [[nodiscard]] double reach_px(std::int64_t t_us) const override;
    [[nodiscard]] const Pose& pose() const override { return pose_; }
    [[nodiscard]] Velocity velocity() const override;
    void describe(std::int64_t t_us, PoseRecord& record) const override;

 private:
    void lay_out();
    void measure_extent();

    TransformKind transform_;
    Pull pull_;
    Contour contour_;
    ObjectParameters parameters_;
    Pose pose_;
    double extent_px_ = 0;   // of the shape about the pose
    double reach2_px2_ = 0;  // and the gate, squared
    DescentGains gains_;
    bool is_laid_out_ = false;  // the contour, for every pose of an isometry
    Slope<5> slope_{0.02};      // of x, y, θ (unwrapped), log sx, log sy
    double turned_rad_ = 0;
    double last_theta_rad_ = 0;
    double residual_px_ = 0.5;

    // What approach() found.
    Eigen::Vector2d q_ = Eigen::Vector2d::Zero();
    Eigen::Vector2d m_ = Eigen::Vector2d::Zero();
    double distance_px_ = 0;
    std::int64_t t_us_ = 0;
};

}  // namespace pursuit::tracker
