// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/evaluation/speed_errors.hpp"

#include <array>
#include <cmath>

#include "services/ctl/evaluation/slopes.hpp"
#include "services/ctl/evaluation/statistics.hpp"

namespace pursuit::ctl {
namespace {

// Below these a ratio of speeds says nothing.
constexpr double least_speed_px_s = 5;
constexpr double least_turning_rad_s = 0.2;

template <class Value>
std::vector<double> column(const Pairs& pairs, Value value) {
    std::vector<double> values;
    for (std::size_t i = 0; i < pairs.size(); ++i) values.push_back(value(i));
    return values;
}

void score_velocity(const Pairs& pairs, std::size_t w, double step_s, Score& score) {
    std::array<std::vector<double>, 2> v;
    std::array<std::vector<double>, 2> dv;
    for (std::size_t k = 0; k < 2; ++k) {
        v[k] = slopes(column(pairs, [&](std::size_t i) { return pairs.truth[i][k]; }), w, step_s);
        dv[k] = slopes(
            column(pairs, [&](std::size_t i) { return pairs.pose[i][k] - pairs.reference[i][k]; }),
            w, step_s);
    }
    std::vector<double> relative;
    double wrong = 0;
    double whole = 0;
    for (std::size_t i = 0; i < v[0].size(); ++i) {
        const double speed = std::hypot(v[0][i], v[1][i]);
        if (!pairs.visible[i + w] || !(speed > least_speed_px_s)) continue;
        const double estimated = std::hypot(v[0][i] + dv[0][i], v[1][i] + dv[1][i]);
        relative.push_back(std::abs(estimated - speed) / speed);
        wrong += std::hypot(dv[0][i], dv[1][i]);
        whole += speed;
    }
    if (relative.empty()) return;
    score.speed_error_pct = 100 * *mean(relative);
    score.velocity_error_pct = 100 * wrong / whole;
}

void score_turning(const Pairs& pairs, std::size_t w, double step_s, Score& score) {
    const auto omega =
        slopes(unwrapped(column(pairs, [&](std::size_t i) { return angle_rad(pairs.truth[i]); })),
               w, step_s);
    const auto d_omega = slopes(unwrapped(column(pairs,
                                                 [&](std::size_t i) {
                                                     return wrapped(angle_rad(pairs.pose[i]) -
                                                                    angle_rad(pairs.reference[i]));
                                                 })),
                                w, step_s);
    double wrong = 0;
    double whole = 0;
    for (std::size_t i = 0; i < omega.size(); ++i) {
        wrong += std::abs(std::abs(omega[i] + d_omega[i]) - std::abs(omega[i]));
        whole += std::abs(omega[i]);
    }
    if (whole > least_turning_rad_s * static_cast<double>(omega.size())) {
        score.omega_error_pct = 100 * wrong / whole;
    }
}

}  // namespace

void score_speeds(const Pairs& pairs, double window_s, Score& score) {
    const double step_s = median_step_us(pairs.t_us) * 1e-6;
    if (!(step_s > 0)) return;
    const auto half_width = [&](double seconds) {
        return static_cast<std::size_t>(std::nearbyint(seconds / step_s));
    };
    const auto fits = [&](std::size_t w) { return w > 0 && pairs.size() > 2 * w + 2; };
    if (fits(half_width(window_s))) score_velocity(pairs, half_width(window_s), step_s, score);
    const double turning_window_s = window_s > 0 ? window_s : 0.02;
    if (fits(half_width(turning_window_s))) {
        score_turning(pairs, half_width(turning_window_s), step_s, score);
    }
}

}  // namespace pursuit::ctl
