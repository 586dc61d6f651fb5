// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/cover.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pursuit::tracker {
namespace {

// What was counted fades to 1/e over so many events.
constexpr double memory_events = 375;

// Also a part that moves along itself makes some events.
constexpr double sideways_share = 0.1;

}  // namespace

Cover::Cover(const Contour& contour) {
    const std::vector<Piece>& pieces = contour.pieces().pieces();
    // Pieces that run on from each other are one part as long as it stays short; any that follow
    // each other only where there would be too many parts.
    const double longest_px = contour.length_px() / usual_parts;
    std::vector<double> length_px;     // by part
    std::vector<std::size_t> first;    // its first piece
    std::vector<std::size_t> part_of;  // by piece
    const auto group = [&](const auto& goes_on) {
        length_px.clear();
        first.clear();
        part_of.clear();
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const Piece& piece = pieces[i];
            const double more_px = std::hypot(piece.bx - piece.ax, piece.by - piece.ay);
            if (i > 0 && goes_on(i, length_px.back() + more_px)) {
                length_px.back() += more_px;
            } else {
                length_px.push_back(more_px);
                first.push_back(i);
            }
            part_of.push_back(first.size() - 1);
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

    // Sectors of equal length, in order of the angle about the centre.
    std::vector<std::size_t> order(first.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto angle = [&](std::size_t part) {
        const Piece& piece = pieces[first[part]];
        return std::atan2((piece.ay + piece.by) / 2, (piece.ax + piece.bx) / 2);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t l, std::size_t r) { return angle(l) < angle(r); });
    for (Numbers* numbers :
         {&middle_px_.x, &middle_px_.y, &along_px_.x, &along_px_.y, &sideways_px_}) {
        numbers->resize(static_cast<Eigen::Index>(order.size()));
    }
    std::vector<std::uint8_t> sector(first.size());
    double before_px = 0;
    for (const std::size_t part : order) {
        const double at = before_px / std::max(contour.length_px(), 1e-9);
        const std::size_t in = std::min(static_cast<std::size_t>(at * sectors), sectors - 1);
        sector[part] = static_cast<std::uint8_t>(in);
        before_px += length_px[part];
        sector_of_part_.push_back(sector[part]);

        const Piece& piece = pieces[first[part]];
        const auto i = static_cast<Eigen::Index>(piece_.size());
        piece_.push_back(static_cast<std::int32_t>(first[part]));
        middle_px_.x(i) = (piece.ax + piece.bx) / 2;
        middle_px_.y(i) = (piece.ay + piece.by) / 2;
        // As long as they all are, the first one's way.
        const double own_px = std::hypot(piece.bx - piece.ax, piece.by - piece.ay);
        const double longer = own_px > 0 ? length_px[part] / own_px : 1;
        along_px_.x(i) = (piece.bx - piece.ax) * longer;
        along_px_.y(i) = (piece.by - piece.ay) * longer;
        sideways_px_(i) = sideways_share * own_px * longer;
    }
    for (const std::size_t part : part_of) sector_of_.push_back(sector[part]);
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
    const Eigen::Matrix2d g = rate_of_arms(a, velocity) * a;
    const MomentaryVectors speed{
        velocity.vx_px_s + g(0, 0) * middle_px_.x + g(0, 1) * middle_px_.y,
        velocity.vy_px_s + g(1, 0) * middle_px_.x + g(1, 1) * middle_px_.y};
    const double fastest2 =
        speed.x.size() > 0 ? (speed.x * speed.x + speed.y * speed.y).maxCoeff() : 0;
    const double per_fastest = 1 / std::max(1e-9, std::sqrt(fastest2));
    const MomentaryVectors along{a(0, 0) * along_px_.x + a(0, 1) * along_px_.y,
                                 a(1, 0) * along_px_.x + a(1, 1) * along_px_.y};
    // As long as it is in the image, but for what A stretches it more or less than others.
    const double scale = std::sqrt(std::abs(a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0)));
    const MomentaryNumbers shows =
        (along.x * speed.y - along.y * speed.x).abs() * per_fastest + scale * sideways_px_;
    std::array<double, sectors> rate{};
    // (In one loop over all parts: of how many there are in a sector, nobody can foresee.)
    for (std::size_t i = 0; i < piece_.size(); ++i) {
        const double shown = shows(static_cast<Eigen::Index>(i));
        rate[sector_of_part_[i]] += outline.can_be_seen(piece_[i]) ? shown : 0;
    }
    double sum = 0;
    for (const double of_sector : rate) sum += of_sector;
    double counted = 0;
    double expected = 0;
    for (std::size_t i = 0; i < sectors; ++i) {
        expected_[i] += events_ * rate[i] / std::max(sum, 1e-9);
        counted += counted_[i];
        expected += expected_[i];
    }
    double covered = 0;
    const double kept_share = std::exp(-events_ / memory_events);
    for (std::size_t i = 0; i < sectors; ++i) {
        if (counted_[i] * expected >= 0.25 * expected_[i] * counted) covered += expected_[i];
        counted_[i] *= kept_share;
        expected_[i] *= kept_share;
    }
    share_ = covered / std::max(expected, 1e-9);
    events_ = 0;
}

}  // namespace pursuit::tracker
