// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/cover.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pursuit::tracker {
namespace {

// What stays of a window's counts when the next is closed: some 400 events are remembered.
constexpr double kept_share = 0.875;

// Also a part that moves along itself makes some events.
constexpr double sideways_share = 0.1;

}  // namespace

Cover::Cover(const Contour& contour) {
    const std::vector<Piece>& pieces = contour.pieces().pieces();
    for (const Piece& piece : pieces) {
        Part part;
        part.middle_px << (piece.ax + piece.bx) / 2, (piece.ay + piece.by) / 2;
        part.along_px << piece.bx - piece.ax, piece.by - piece.ay;
        parts_.push_back(part);
    }
    // Sectors of equal length, in order of the angle about the centre.
    std::vector<std::size_t> order(parts_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto angle = [&](std::size_t i) {
        return std::atan2(parts_[i].middle_px.y(), parts_[i].middle_px.x());
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t l, std::size_t r) { return angle(l) < angle(r); });
    double length_px = 0;
    for (const std::size_t i : order) {
        const double at = length_px / std::max(contour.length_px(), 1e-9);
        parts_[i].sector = std::min(static_cast<std::size_t>(at * sectors), sectors - 1);
        length_px += parts_[i].along_px.norm();
    }
}

void Cover::restart() {
    counted_ = {};
    expected_ = {};
    events_ = 0;
    share_ = 1;
}

void Cover::count(std::int32_t piece, const Outline& outline, const Pose& pose,
                  const Velocity& velocity) {
    ++counted_[parts_[static_cast<std::size_t>(piece)].sector];
    if (++events_ >= window_events) close_window(outline, pose, velocity);
}

void Cover::close_window(const Outline& outline, const Pose& pose, const Velocity& velocity) {
    std::array<double, sectors> rate{};
    const Eigen::Vector2d v(velocity.vx_px_s, velocity.vy_px_s);
    double fastest_px_s = 1e-9;
    for (const Part& part : parts_) {
        const Eigen::Vector2d d = pose.a * part.middle_px;
        const Eigen::Vector2d speed = v + velocity.omega_rad_s * Eigen::Vector2d(-d.y(), d.x()) +
                                      velocity.scale_x_rate_per_s * d;
        fastest_px_s = std::max(fastest_px_s, speed.norm());
    }
    double sum = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const Part& part = parts_[i];
        if (outline.is_hidden(static_cast<std::int32_t>(i))) continue;
        const Eigen::Vector2d d = pose.a * part.middle_px;
        const Eigen::Vector2d speed = v + velocity.omega_rad_s * Eigen::Vector2d(-d.y(), d.x()) +
                                      velocity.scale_x_rate_per_s * d;
        const Eigen::Vector2d along = pose.a * part.along_px;
        const double across = std::abs(along.x() * speed.y() - along.y() * speed.x());
        const double part_rate = across / fastest_px_s + sideways_share * along.norm();
        rate[part.sector] += part_rate;
        sum += part_rate;
    }
    double counted = 0;
    double expected = 0;
    for (std::size_t i = 0; i < sectors; ++i) {
        expected_[i] += events_ * rate[i] / std::max(sum, 1e-9);
        counted += counted_[i];
        expected += expected_[i];
    }
    double covered = 0;
    for (std::size_t i = 0; i < sectors; ++i) {
        if (counted_[i] * expected >= 0.25 * expected_[i] * counted) covered += expected_[i];
        counted_[i] *= kept_share;
        expected_[i] *= kept_share;
    }
    share_ = covered / std::max(expected, 1e-9);
    events_ = 0;
}

}  // namespace pursuit::tracker
