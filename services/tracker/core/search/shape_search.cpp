// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/search/shape_search.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "services/tracker/core/search/drawn_contour.hpp"

namespace pursuit::tracker {
namespace {

// Below: chance, or a part of the shape alone.
constexpr double least_score = 0.4;
// The best of very many poses fits noise better than chance, the more of it there is.
constexpr double chance_margin = 0.9;

// Or what fires there lies on the shape, though what lies beside the contour has fired as well: its
// other lines, or where they were a moment ago.
constexpr double least_hits = 0.65;
constexpr double least_explained = 0.7;
constexpr double on_it_px = 5.0 / 3;
constexpr double near_it_px = 6;

// Where the object is expected counts for so much of the contour.
constexpr double seed_bonus = 0.05;
constexpr double far_malus_of_check = 0.05;
constexpr double far_malus = 0.15;

constexpr std::size_t directions = 8;

// To fit a pose, and to count what fired near one, take as long as to look at so many coarsely.
constexpr int poses_per_fit = 300;
constexpr int poses_per_count = 600;

constexpr double sideways = 0.1;  // what moves along itself still fires a little
constexpr double hit = 1.4;       // cells: the contour fired here
constexpr double beside = 4;      // px off the contour, where only chance has fired

}  // namespace

ShapeSearch::ShapeSearch(const Contour& contour) : ShapeSearch(contour, Outline(contour)) {}

ShapeSearch::ShapeSearch(const Contour& contour, const Outline& outline)
    : radius_px_(contour.radius_px()) {
    const std::vector<Piece>& pieces = contour.pieces().pieces();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (!outline.can_be_seen(static_cast<std::int32_t>(i))) continue;
        pieces_.push_back(pieces[i]);
        length_px_ += std::hypot(pieces[i].bx - pieces[i].ax, pieces[i].by - pieces[i].ay);
    }
    std::vector<Eigen::Vector2d> coarse_px;
    for (const Sample& sample : samples(CoarseSearch::points)) coarse_px.push_back(sample.at_px);
    coarse_ = CoarseSearch(coarse_px, radius_px_, length_px_);
    fine_ = samples(fine_points);
}

void ShapeSearch::draw() {
    constexpr double margin_px = near_it_px + 2;
    drawn_from_px_.setConstant(-radius_px_ - margin_px);
    const auto side = static_cast<std::uint16_t>(std::ceil(2 * (radius_px_ + margin_px)) + 1);
    drawn_.build({side, side}, drawn_contour(pieces_, drawn_from_px_, {side, side}));
}

// At equal distances along the contour.
std::vector<ShapeSearch::Sample> ShapeSearch::samples(int count) const {
    std::vector<Sample> samples;
    double gone_px = 0;
    for (const Piece& piece : pieces_) {
        const Eigen::Vector2d a(piece.ax, piece.ay);
        const Eigen::Vector2d along(piece.bx - piece.ax, piece.by - piece.ay);
        const double end_px = gone_px + along.norm();
        while (static_cast<int>(samples.size()) < count) {
            const double at_px = (static_cast<double>(samples.size()) + 0.5) / count * length_px_;
            if (at_px >= end_px) break;
            const Eigen::Vector2d unit = along.normalized();
            samples.push_back({a + (at_px - gone_px) * unit, {-unit.y(), unit.x()}});
        }
        gone_px = end_px;
    }
    // Shapes without edges: their points.
    for (std::size_t i = 0; static_cast<int>(samples.size()) < count && !pieces_.empty(); ++i) {
        const Piece& piece = pieces_[i * 7 % pieces_.size()];
        samples.push_back({{piece.ax, piece.ay}, {1, 0}});
    }
    return samples;
}

void ShapeSearch::begin(const FiredMap& map, const SearchRange& range) {
    map_ = &map;
    range_ = range;
    found_.reset();
    seed_next_ = counted_next_ = stretched_next_ = fine_next_ = 0;
    fired_about_ = 1;
    coarse_.begin(map, range);
    stage_ = Stage::coarse;
}

void ShapeSearch::step(int poses) {
    for (; poses > 0 && counted_next_ < range_.stretched.size(); poses -= poses_per_count) {
        const Fired fired = fired_near(range_.stretched[counted_next_++]);
        fired_about_ = std::max<double>(fired_about_, fired.near_it);
    }
    if (stage_ == Stage::coarse) {
        coarse_.step(poses);
        if (coarse_.is_done()) stage_ = Stage::fine;
    }
    while (poses > 0 && stage_ == Stage::fine) {
        if (seed_next_ < range_.seeds.size()) {
            weigh(range_.seeds[seed_next_++], From::seed);
        } else if (stretched_next_ < range_.stretched.size()) {
            weigh(range_.stretched[stretched_next_++], From::stretched);
        } else if (fine_next_ < coarse_.count()) {
            weigh(coarse_.pose(fine_next_++), From::grid);
        } else {
            stage_ = Stage::done;
        }
        poses -= poses_per_fit;
    }
}

void ShapeSearch::weigh(const Pose& pose, From from) {
    const Pose fit_pose = fitted(pose, from == From::stretched);
    const Fit fit = fit_of(fit_pose);
    const double far = (fit_pose.t_px - range_.around.t_px).norm() / range_.usual_distance_px;
    double worth =
        fit.score + (from == From::seed ? seed_bonus
                                        : -(range_.is_check ? far_malus_of_check : far_malus) *
                                              std::min(far * far, 4.0));
    bool is_sure = fit.score > least_score + chance_margin * fit.chance;
    if (!range_.is_check) {
        const double share = explained(fit_pose);
        worth += share;
        const double hits = fit.chance + fit.score * (1 - fit.chance);
        is_sure |= fit.score > least_score && hits > least_hits && share > least_explained;
    }
    // Of shapes drawn out differently a small one may fit as well as the right one, and explains
    // only a part of what the right one does.
    double rank = worth;
    if (!range_.stretched.empty()) rank += explained(fit_pose);
    if ((is_sure || range_.is_check) && (!found_ || rank > highest_rank_)) {
        found_ = Found{fit_pose, worth, is_sure};
        highest_rank_ = rank;
    }
}

double ShapeSearch::mean_distance(const Pose& pose) const {
    int sum = 0;
    for (const Sample& sample : fine_) {
        const Eigen::Vector2d p = (pose.t_px + pose.a * sample.at_px) / map_->cell_px();
        sum += map_->distance(static_cast<int>(std::lround(p.x())),
                              static_cast<int>(std::lround(p.y())));
    }
    return static_cast<double>(sum) / fine_points;
}

// Downhill along one direction after another, with steps that shrink.
Pose ShapeSearch::fitted(Pose pose, bool stretches) const {
    double best = mean_distance(pose);
    const double rim_px = std::max(radius_px_, 4.0);
    const int directions_tried = stretches ? 10 : range_.log_scale > 0 ? 8 : 6;
    for (double step_px = 2; step_px > 0.4; step_px /= 2) {
        for (int round = 0; round < 3; ++round) {
            bool has_moved = false;
            for (int direction = 0; direction < directions_tried; ++direction) {
                Pose tried = pose;
                const double sign = direction % 2 == 0 ? 1 : -1;
                if (direction < 2) tried.t_px.x() += sign * step_px;
                if (direction / 2 == 1) tried.t_px.y() += sign * step_px;
                if (direction / 2 == 2) tried.a = rotation(sign * step_px / rim_px) * pose.a;
                if (direction / 2 == 3 && !stretches) tried.a *= 1 + sign * step_px / rim_px;
                if (direction / 2 == 3 && stretches) tried.a.col(0) *= 1 + sign * step_px / rim_px;
                if (direction / 2 == 4) tried.a.col(1) *= 1 + sign * step_px / rim_px;
                const double value = mean_distance(tried);
                if (value < best) {
                    best = value;
                    pose = tried;
                    has_moved = true;
                }
            }
            if (!has_moved) break;
        }
    }
    return pose;
}

double ShapeSearch::explained(const Pose& pose) {
    const Fired fired = fired_near(pose);
    const double all = range_.stretched.empty() ? fired.near_it : fired_about_;
    return all > 0 ? fired.on_it / all : 0;
}

ShapeSearch::Fired ShapeSearch::fired_near(const Pose& pose) {
    if (drawn_.columns() == 0) draw();
    const Eigen::Matrix2d model_from_image = pose.a.inverse();
    const double cell_px = map_->cell_px();
    const double reach_px = pose.a.norm() * radius_px_ + near_it_px;
    const FiredMap::Cells near = map_->cells_near(pose.t_px.x(), pose.t_px.y(), reach_px);
    const auto thirds = [&](double px) { return 3 * px / drawn_.cell_px(); };
    Fired fired;
    for (int row = near.top; row < near.bottom; ++row) {
        for (int column = near.left; column < near.right; ++column) {
            if (map_->distance(column, row) != 0) continue;
            const Eigen::Vector2d p((column + 0.5) * cell_px - 0.5, (row + 0.5) * cell_px - 0.5);
            const Eigen::Vector2d m =
                (model_from_image * (p - pose.t_px) - drawn_from_px_) / drawn_.cell_px();
            const int distance = drawn_.distance(static_cast<int>(std::lround(m.x())),
                                                 static_cast<int>(std::lround(m.y())));
            if (distance > thirds(near_it_px)) continue;
            ++fired.near_it;
            fired.on_it += distance <= thirds(on_it_px) ? 1 : 0;
        }
    }
    return fired;
}

ShapeSearch::Fit ShapeSearch::fit_of(const Pose& pose) const {
    const auto has_fired = [&](const Eigen::Vector2d& p_px) {
        const Eigen::Vector2d p = p_px / map_->cell_px();
        return map_->distance(static_cast<int>(std::lround(p.x())),
                              static_cast<int>(std::lround(p.y()))) <= hit * 3
                   ? 1.0
                   : 0.0;
    };
    // What moves along itself does not fire. Which way the shape moves is not known: any way, or
    // all of the contour alike, as when it turns.
    struct Sums {
        double weight = 0;
        double hits = 0;
        double chance = 0;
    };
    std::array<Sums, directions + 1> ways{};
    for (const Sample& sample : fine_) {
        const Eigen::Vector2d p = pose.t_px + pose.a * sample.at_px;
        const Eigen::Vector2d n = (pose.a * sample.normal_px).normalized();
        const double hits = has_fired(p);
        const double chance = (has_fired(p + beside * n) + has_fired(p - beside * n)) / 2;
        for (std::size_t i = 0; i <= directions; ++i) {
            const double angle = static_cast<double>(i) * std::numbers::pi / directions;
            const double across = std::abs(n.x() * std::cos(angle) + n.y() * std::sin(angle));
            const double weight = i == directions ? 1 : sideways + across;
            ways[i].weight += weight;
            ways[i].hits += weight * hits;
            ways[i].chance += weight * chance;
        }
    }
    Fit best{-1, 0};
    for (const Sums& way : ways) {
        const double chance = way.chance / way.weight;
        const double score = (way.hits / way.weight - chance) / std::max(1 - chance, 0.1);
        if (score > best.score) best = {score, chance};
    }
    return best;
}

}  // namespace pursuit::tracker
