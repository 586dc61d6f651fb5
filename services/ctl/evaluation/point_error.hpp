// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>

#include "services/ctl/evaluation/evaluate.hpp"

namespace pursuit::ctl {

/// rms distance of the model's points under two poses, from the points' moments.
class PointError {
 public:
    explicit PointError(const ModelPoints& model) {
        for (const auto& point : model) {
            moments_ += point * point.transpose() / static_cast<double>(model.size());
            mean_ += point / static_cast<double>(model.size());
        }
    }

    /// Of the best of `symmetry` turns of the first pose's shape.
    double operator()(const PoseNumbers& p, const PoseNumbers& q, int symmetry = 1) const {
        const auto matrix = [](const PoseNumbers& n) {
            return (Eigen::Matrix2d() << n[2], n[3], n[4], n[5]).finished();
        };
        const Eigen::Vector2d shift(p[0] - q[0], p[1] - q[1]);
        double best = std::numeric_limits<double>::infinity();
        for (int k = 0; k < symmetry; ++k) {
            const double turn = 2 * std::numbers::pi * k / symmetry;
            Eigen::Matrix2d rotation;
            rotation << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
            const Eigen::Matrix2d difference = matrix(p) * rotation - matrix(q);
            const double square = (difference * moments_ * difference.transpose()).trace() +
                                  2 * shift.dot(difference * mean_) + shift.squaredNorm();
            best = std::min(best, std::sqrt(std::max(square, 0.0)));
        }
        return best;
    }

 private:
    Eigen::Matrix2d moments_ = Eigen::Matrix2d::Zero();
    Eigen::Vector2d mean_ = Eigen::Vector2d::Zero();
};

}  // namespace pursuit::ctl
