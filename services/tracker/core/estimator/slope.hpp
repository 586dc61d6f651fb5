// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pursuit::tracker {

/// Slope of values over time: least squares with weights that fade over the memory. For estimators
/// that have no velocity of their own.
template <int N>
class Slope {
 public:
    using Values = Eigen::Matrix<double, N, 1>;

    explicit Slope(double memory_s) : memory_s_(memory_s) {}

    void restart() { *this = Slope(memory_s_); }

    /// Whether a sample at this time is wanted: 1/50 of the memory after the last.
    [[nodiscard]] bool is_due(std::int64_t t_us) const { return t_us >= due_us_; }

    void add(std::int64_t t_us, const Values& values) {
        if (weight_ > 0) fade(static_cast<double>(t_us - t_us_) * 1e-6);
        t_us_ = t_us;
        due_us_ = t_us + static_cast<std::int64_t>(std::ceil(memory_s_ / 50 * 1e6));
        weight_ += 1;  // at time 0, so the sums of time stay
        sum_ += values;
    }

    /// Per second; zero before two samples.
    [[nodiscard]] Values per_s() const {
        const double spread = weight_ * time2_ - time_ * time_;
        if (!(spread > 1e-12)) return Values::Zero();
        return (weight_ * time_sum_ - time_ * sum_) / spread;
    }

 private:
    // Moves the origin of time to dt_s later and lets all weights fade.
    void fade(double dt_s) {
        const double kept = std::exp(-dt_s / memory_s_);
        time_sum_ = (time_sum_ - dt_s * sum_) * kept;
        time2_ = (time2_ - 2 * dt_s * time_ + dt_s * dt_s * weight_) * kept;
        time_ = (time_ - dt_s * weight_) * kept;
        sum_ *= kept;
        weight_ *= kept;
    }

    double memory_s_;
    std::int64_t t_us_ = 0;
    std::int64_t due_us_ = std::numeric_limits<std::int64_t>::min();
    double weight_ = 0;
    double time_ = 0;
    double time2_ = 0;
    Values sum_ = Values::Zero();
    Values time_sum_ = Values::Zero();
};

}  // namespace pursuit::tracker
