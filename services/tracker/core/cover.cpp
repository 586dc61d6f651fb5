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
    // Pieces that run on from each other are one part as long as it stays short; any that follow
    // each other only where there would be too many parts.
    const double longest_px = contour.length_px() / usual_parts;
    std::vector<double> length_px;
    std::vector<std::size_t> first;
    const auto group = [&](const auto& goes_on) {
        length_px.clear();
        first.clear();
        part_of_.clear();
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const Piece& piece = pieces[i];
            const double more_px = std::hypot(piece.bx - piece.ax, piece.by - piece.ay);
            if (i > 0 && goes_on(i, length_px.back() + more_px)) {
                length_px.back() += more_px;
            } else {
                length_px.push_back(more_px);
                first.push_back(i);
            }
            part_of_.push_back(static_cast<std::uint16_t>(first.size() - 1));
        }
    };
    group([&](std::size_t i, double together_px) {
        return together_px < longest_px && pieces[i].ax == pieces[i - 1].bx &&
               pieces[i].ay == pieces[i - 1].by;
    });
    if (first.size() > most_parts) {
        const std::size_t of_one = (pieces.size() + most_parts - 1) / most_parts;
        group([&](std::size_t i, double) { return i % of_one != 0; });
    }

    const auto parts = static_cast<Eigen::Index>(first.size());
    for (Numbers* numbers : {&middle_px_.x, &middle_px_.y, &along_px_.x, &along_px_.y}) {
        numbers->resize(parts);
    }
    for (Eigen::Index part = 0; part < parts; ++part) {
        const std::size_t i = first[static_cast<std::size_t>(part)];
        const Piece& piece = pieces[i];
        piece_.push_back(static_cast<std::int32_t>(i));
        middle_px_.x(part) = (piece.ax + piece.bx) / 2;
        middle_px_.y(part) = (piece.ay + piece.by) / 2;
        // As long as they all are, the first one's way.
        const Eigen::Vector2d along(piece.bx - piece.ax, piece.by - piece.ay);
        const double own_px = along.norm();
        const double longer = own_px > 0 ? length_px[static_cast<std::size_t>(part)] / own_px : 1;
        along_px_.x(part) = along.x() * longer;
        along_px_.y(part) = along.y() * longer;
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
