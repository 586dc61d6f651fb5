// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/estimator/gradient_estimator.hpp"
#include "services/tracker/core/life/cover.hpp"
#include "services/tracker/core/life/health.hpp"

namespace pursuit::tracker {

/// Finds an object near a pose that is many pixels off: the descent with a gate as wide as its
/// residuals are large, pulling along the whole contour. Done when what comes lies on the contour.
/// Events of something else may draw the shape out of all proportion: then it begins again.
class Acquisition {
 public:
    explicit Acquisition(const RegisteredObject& object);
    Acquisition(TransformKind transform, const Contour& contour,
                const ObjectParameters& parameters);

    void begin(const Pose& pose) { begin(pose, widest_gate_px); }
    /// From a pose that is known to a third of the gate or so.
    void begin(const Pose& pose, double gate_px);

    const Approach* approach(const Event& event);
    /// Of that event under the object, 1/px.
    [[nodiscard]] double likelihood() const { return estimator_->likelihood(); }
    /// Uses the event that approach() was asked for last.
    void take();

    /// The events lie on the contour: the pose can be trusted to a pixel or so.
    [[nodiscard]] bool is_done() const {
        return health_.is_settled() && health_.is_good() && cover_.share() > Health::good_cover;
    }
    [[nodiscard]] double reach_px(std::int64_t t_us) const { return estimator_->reach_px(t_us); }
    [[nodiscard]] const Pose& pose() const { return estimator_->pose(); }
    [[nodiscard]] Velocity velocity() const { return estimator_->velocity(); }

 private:
    static constexpr double widest_gate_px = 30;

    void set_gate(double gate_px);
    /// Whether it is still about as large and as wide to its height as it began.
    [[nodiscard]] bool keeps_its_form() const;

    ObjectParameters parameters_;
    std::unique_ptr<Estimator> estimator_;
    double gyration_px_;
    Outline outline_;
    Cover cover_;
    Health health_;
    std::int32_t piece_ = -1;
    std::int64_t t_us_ = 0;
    double distance_px_ = 0;
    double residual_px_ = 0;
    double narrow_px_ = 0;  // the gate of what has arrived
    Pose began_at_;
    double began_gate_px_ = 0;
    Eigen::Matrix2d began_from_a_ = Eigen::Matrix2d::Identity();  // the inverse of A as it began
};

}  // namespace pursuit::tracker
