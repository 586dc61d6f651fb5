// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "services/tracker/core/estimator/twist_filter.hpp"
#include "services/tracker/core/pose_record.hpp"

namespace pursuit::tracker {

/// Fills in how well the record's pose and velocity are known, dt_s after the filter was told last:
/// as far as its state is known, and how far it can have gone since; and by `common`, the variance
/// that all events have in common, a component each: no number of them takes it away. The record's
/// pose must be set.
template <TransformKind kind>
void tell_covariance(const TwistFilter<kind>& filter, double dt_s,
                     const typename TwistFilter<kind>::Step& common, PoseRecord& record) {
    constexpr int dof = TwistFilter<kind>::dof;
    using Square = Eigen::Matrix<double, dof, dof>;
    const typename TwistFilter<kind>::Covariance p = filter.covariance();
    const Square pv = p.template block<dof, dof>(0, dof);
    const Square vv = p.template block<dof, dof>(dof, dof);
    Square pose =
        p.template topLeftCorner<dof, dof>() + dt_s * (pv + pv.transpose()) + dt_s * dt_s * vv;
    pose.diagonal() += common;
    const auto j = Motion<kind>::readable(record.pose.a);
    const auto fill = [](const Eigen::Matrix<double, 6, 6>& read, int size, auto& upper_rows) {
        std::size_t i = 0;
        for (int row = 0; row < size; ++row) {
            for (int column = row; column < size; ++column, ++i) upper_rows[i] = read(row, column);
        }
    };
    fill(j * pose * j.transpose(), 6, record.pose_covariance);
    fill(j * vv * j.transpose(), 3, record.velocity_covariance);
}

}  // namespace pursuit::tracker
