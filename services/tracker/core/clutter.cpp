// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/clutter.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace pursuit::tracker {
namespace {

constexpr std::int64_t fold_us = 5'000;
constexpr double far_memory_s = 0.5;
constexpr double near_window_events = 10;

}  // namespace

void Clutter::restart() {
    far_events_ = {};
    near_events_ = own_events_ = events_ = 0;
    density_ = standing_density_ = {floor, floor};
    own_share_ = 1;
    new_far_ = far_hz_ = {};
    near_count_ = near_time_us_ = slack_us_ = 0;
    folded_us_ = fold_at_us_ = t_us_ = 0;
}

void Clutter::sample(const Contour& contour, const Eigen::Matrix2d& a) {
    const ImageMetric metric(a);
    const Eigen::Matrix2d inverse = a.inverse();
    const double reach_px = contour.radius_px() * a.norm() + far_to_px + 1;
    const double step_px = std::max(1.0, reach_px / 128);
    std::array<double, 2> near_area_px2{};
    far_area_px2_ = {};
    for (double y = -reach_px; y <= reach_px; y += step_px) {
        for (double x = -reach_px; x <= reach_px; x += step_px) {
            const Eigen::Vector2d image(x, y);
            const Eigen::Vector2d m = inverse * image;
            const auto nearest = contour.pieces().nearest(m.x(), m.y(), metric);
            if (nearest.piece < 0) continue;
            const double distance_px = std::sqrt(nearest.squared_px);
            if (distance_px > far_to_px) continue;
            const Piece& piece = contour.pieces().pieces()[static_cast<std::size_t>(nearest.piece)];
            const Eigen::Vector2d along =
                a * Eigen::Vector2d(piece.bx - piece.ax, piece.by - piece.ay);
            const Eigen::Vector2d from = image - a * Eigen::Vector2d(piece.ax, piece.ay);
            const bool side = along.y() * from.x() - along.x() * from.y() > 0;
            if (distance_px < near_px) near_area_px2[side] += step_px * step_px;
            if (distance_px > far_from_px) far_area_px2_[side] += step_px * step_px;
        }
    }
    for (std::size_t side = 0; side < 2; ++side) {
        near_width_px_[side] = near_area_px2[side] / near_px;
        far_area_px2_[side] = std::max(far_area_px2_[side], 1.0);
    }
}

void Clutter::count_far(double r_px) {
    ++far_events_[r_px > 0];
    ++new_far_[r_px > 0];
    if (++events_ >= window_events) close_window();
}

void Clutter::count_near(double share) {
    own_events_ += share;
    ++near_events_;
    if (++near_count_ > near_window_events) {
        near_time_us_ *= near_window_events / near_count_;
        near_count_ = near_window_events;
    }
    if (++events_ >= window_events) close_window();
}

void Clutter::fold(std::int64_t t_us) {
    const double dt_s = static_cast<double>(t_us - folded_us_) * 1e-6;
    folded_us_ = t_us;
    fold_at_us_ = t_us + fold_us;
    const double far_kept = std::exp(-dt_s / far_memory_s);
    const double near_hz = near_count_ / std::max(near_time_us_, 1.0) * 1e6;
    slack_us_ = 2 * near_time_us_;
    double clutter_hz = 0;
    for (std::size_t side = 0; side < 2; ++side) {
        far_hz_[side] = far_hz_[side] * far_kept + new_far_[side] / far_memory_s;
        clutter_hz += far_hz_[side] / far_area_px2_[side] * near_width_px_[side] * near_px;
    }
    const double own_hz = std::max({near_hz - clutter_hz, 0.1 * near_hz, 1e-3});
    for (std::size_t side = 0; side < 2; ++side) {
        standing_density_[side] =
            far_hz_[side] / far_area_px2_[side] * near_width_px_[side] / own_hz;
    }
    new_far_ = {};
}

void Clutter::close_window() {
    const double far_area_px2 = far_area_px2_[0] + far_area_px2_[1];
    const double mean_density = (far_events_[0] + far_events_[1]) / far_area_px2;
    const double prior_px2 = 0.1 * far_area_px2;
    const double own = std::max(own_events_, 0.05 * events_);
    double clutter_on_contour = 0;
    for (std::size_t side = 0; side < 2; ++side) {
        const double beside =
            (far_events_[side] + prior_px2 * mean_density) / (far_area_px2_[side] + prior_px2);
        density_[side] = std::max(floor, beside * near_width_px_[side] / own);
        clutter_on_contour += beside * near_width_px_[side] * near_px;
    }
    own_share_ = std::clamp(1 - clutter_on_contour / std::max(near_events_, 1.0), 0.0, 1.0);
    // Half of what was counted stays: the window slides.
    for (double& events : far_events_) events *= 0.5;
    near_events_ *= 0.5;
    own_events_ *= 0.5;
    events_ *= 0.5;
}

}  // namespace pursuit::tracker
