// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>

#include "services/common/event.hpp"
#include "services/tracker/core/contour.hpp"
#include "services/tracker/core/pose_record.hpp"
#include "services/tracker/core/registration.hpp"

namespace pursuit::tracker {

/// Moves one object's pose by its events. Both ideas, the paper's gradient and the filter, are one
/// of these. approach() asks how near an event is; take() moves the pose by the event that was
/// asked for last. Between the two nothing else is called.
class Estimator {
 public:
    virtual ~Estimator() = default;

    /// Begins anew at a pose; `sure` where it is known to a px or so.
    virtual void restart(const Pose& pose, const Velocity& velocity) = 0;
    virtual void set_parameters(const ObjectParameters& parameters) = 0;

    /// The event's distance to the model in the image, px; `beyond` outside the gate.
    /// since_same_us: since the last event of the same pixel and polarity.
    virtual double approach(const Event& event, std::int64_t since_same_us) = 0;

    /// Uses the event with a weight 0 … 1; false where it came to nothing.
    virtual bool take(double weight) = 0;

    [[nodiscard]] virtual const Pose& pose() const = 0;

    /// Fills in pose, velocity, covariances, residual and rate at a time after the last event.
    virtual void describe(std::int64_t t_us, PoseRecord& record) const = 0;

    static constexpr double beyond = std::numeric_limits<double>::infinity();
};

std::unique_ptr<Estimator> make_estimator(EstimatorKind kind, TransformKind transform,
                                          const Shape& shape, const ObjectParameters& parameters);

}  // namespace pursuit::tracker
