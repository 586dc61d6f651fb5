// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/evaluation/pairs.hpp"

#include <algorithm>
#include <cmath>

#include "services/ctl/evaluation/interpolation.hpp"
#include "services/ctl/evaluation/statistics.hpp"

namespace pursuit::ctl {
namespace {

constexpr double lie_confidence = 0.5;  // above it a pose claims to be right

}  // namespace

bool is_finite(const PoseNumbers& pose) {
    return std::all_of(pose.begin(), pose.end(), [](double n) { return std::isfinite(n); });
}

ObjectRows started_rows(const ObjectRows& rows) {
    ObjectRows kept{rows.model, rows.object_id, {}, {}, {}, {}, {}};
    bool started = false;
    for (std::size_t i = 0; i < rows.t_us.size(); ++i) {
        started = started || rows.state[i] == "TRACKING" || rows.state[i] == "OCCLUDED";
        const bool finite = is_finite(rows.pose[i]);
        if (!started || (kept.pose.empty() && !finite)) continue;
        kept.t_us.push_back(rows.t_us[i]);
        kept.pose.push_back(finite ? rows.pose[i] : kept.pose.back());
        kept.state.push_back(rows.state[i]);
        kept.confidence.push_back(rows.confidence[i]);
    }
    return kept;
}

bool is_scored(double t_us, const EvaluationSettings& settings) {
    return t_us >= settings.from_s * 1e6 && (settings.to_s <= 0 || t_us <= settings.to_s * 1e6);
}

Pairs pair_up(const ObjectRows& started, const ObjectRows& truth,
              const EvaluationSettings& settings) {
    const PoseCurve curve(truth.t_us, truth.pose);
    Pairs pairs;
    for (std::size_t k = 0; k < truth.t_us.size(); ++k) {
        const double t_us = truth.t_us[k];
        if (!is_scored(t_us, settings)) continue;
        ++pairs.wanted;
        const std::size_t rows = count_up_to(started.t_us, t_us);
        if (rows == 0) continue;
        const std::size_t i = rows - 1;
        const bool fresh = t_us - started.t_us[i] <= settings.fresh_ms * 1e3;
        pairs.t_us.push_back(t_us);
        pairs.truth.push_back(truth.pose[k]);
        pairs.pose.push_back(started.pose[i]);
        pairs.reference.push_back(fresh ? curve.at(started.t_us[i]) : truth.pose[k]);
        pairs.tracking.push_back(started.state[i] == "TRACKING");
        pairs.confident.push_back(pairs.tracking.back() && started.confidence[i] > lie_confidence);
        pairs.visible.push_back(truth.visible[k] >= 0.5);
    }
    return pairs;
}

double median_step_us(const Numbers& t_us) {
    Numbers steps;
    for (std::size_t i = 1; i < t_us.size(); ++i) steps.push_back(t_us[i] - t_us[i - 1]);
    return steps.empty() ? 0 : quantile(steps, 0.5);
}

}  // namespace pursuit::ctl
