// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/ctl/evaluation/evaluate.hpp"

namespace pursuit::ctl {

/// The rows from the first TRACKING or OCCLUDED one on that has numbers, or has them before it;
/// rows without numbers hold the pose before.
ObjectRows started_rows(const ObjectRows& rows);

/// What is compared: at each scored time of the truth, the pose held then and the truth for it.
struct Pairs {
    std::vector<double> t_us;
    std::vector<PoseNumbers> truth;      // at t_us
    std::vector<PoseNumbers> pose;       // held at t_us
    std::vector<PoseNumbers> reference;  // the truth that the pose is compared with
    std::vector<bool> tracking, confident, visible;
    std::size_t wanted = 0;  // times of the truth within the scored range

    std::size_t size() const { return t_us.size(); }
};

/// Whether that time of the truth is within the scored range.
bool is_scored(double t_us, const EvaluationSettings& settings);

Pairs pair_up(const ObjectRows& started, const ObjectRows& truth,
              const EvaluationSettings& settings);

bool is_finite(const PoseNumbers& pose);

/// Median difference of rising times; 0 of fewer than two.
double median_step_us(const std::vector<double>& t_us);

}  // namespace pursuit::ctl
