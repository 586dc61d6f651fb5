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
    const std::size_t of_one = (pieces.size() + most_parts - 1) / most_parts;
    const auto parts = static_cast<Eigen::Index>((pieces.size() + of_one - 1) / of_one);
    for (Numbers* numbers : {&middle_px_.x, &middle_px_.y, &along_px_.x, &along_px_.y}) {
        numbers->resize(parts);
    }
    std::vector<double> length_px(static_cast<std::size_t>(parts));
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Piece& piece = pieces[i];
        const Eigen::Vector2d along(piece.bx - piece.ax, piece.by - piece.ay);
        const auto part = static_cast<Eigen::Index>(i / of_one);
        part_of_.push_back(static_cast<std::uint16_t>(part));
        if (i % of_one == 0) {
            piece_.push_back(static_cast<std::int32_t>(i));
            middle_px_.x(part) = (piece.ax + piece.bx) / 2;
            middle_px_.y(part) = (piece.ay + piece.by) / 2;
            along_px_.x(part) = along.x();
            along_px_.y(part) = along.y();
            length_px[static_cast<std::size_t>(part)] = along.norm();
        } else if (length_px[static_cast<std::size_t>(part)] > 0) {
            // As long as they all are, the first one's way.
            double& length = length_px[static_cast<std::size_t>(part)];
            const double longer = 1 + along.norm() / length;
            length *= longer;
            along_px_.x(part) *= longer;
            along_px_.y(part) *= longer;
        }
    }
    // Sectors of equal length, in order of the angle about the centre.
    std::vector<Eigen::Index> order(static_cast<std::size_t>(parts));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    const auto angle = [&](Eigen::Index i) { return std::atan2(middle_px_.y(i), middle_px_.x(i)); };
    std::stable_sort(order.begin(), order.end(),
                     [&](Eigen::Index l, Eigen::Index r) { return angle(l) < angle(r); });
    sector_.resize(static_cast<std::size_t>(parts));
    double before_px = 0;
    for (const Eigen::Index i : order) {
        const double at = before_px / std::max(contour.length_px(), 1e-9);
        sector_[static_cast<std::size_t>(i)] =
            std::min(static_cast<std::size_t>(at * sectors), sectors - 1);
        before_px += length_px[static_cast<std::size_t>(i)];
    }
}

void Cover::restart() {
    counted_ = {};
    expected_ = {};
    events_ = 0;
    share_ = 1;
}

void Cover::close_window(const Outline& outline, const Pose& pose, const Velocity& velocity) {
    const Eigen::Matrix2d& a = pose.a;
    // The speed of each part's middle, and what of it goes across the part.
    const Vectors d{a(0, 0) * middle_px_.x + a(0, 1) * middle_px_.y,
                    a(1, 0) * middle_px_.x + a(1, 1) * middle_px_.y};
    const double omega = velocity.omega_rad_s;
    const double growth = velocity.scale_x_rate_per_s;
    const Vectors speed{(velocity.vx_px_s - omega * d.y) + growth * d.x,
                        (velocity.vy_px_s + omega * d.x) + growth * d.y};
    const Vectors along{a(0, 0) * along_px_.x + a(0, 1) * along_px_.y,
                        a(1, 0) * along_px_.x + a(1, 1) * along_px_.y};
    const double fastest2 = (speed.x * speed.x + speed.y * speed.y).maxCoeff();
    const double fastest_px_s = std::max(1e-9, std::sqrt(fastest2));
    const Numbers part_rate = (along.x * speed.y - along.y * speed.x).abs() / fastest_px_s +
                              sideways_share * (along.x * along.x + along.y * along.y).sqrt();
    std::array<double, sectors> rate{};
    double sum = 0;
    for (std::size_t i = 0; i < sector_.size(); ++i) {
        if (outline.is_hidden(piece_[i])) continue;
        rate[sector_[i]] += part_rate(static_cast<Eigen::Index>(i));
        sum += part_rate(static_cast<Eigen::Index>(i));
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
