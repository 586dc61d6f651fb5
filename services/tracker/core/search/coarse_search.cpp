// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/search/coarse_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pursuit::tracker {
namespace {

constexpr double stride_px = 3;
constexpr double rim_step_px = 4;  // the rim moves so far from one angle to the next
constexpr double scale_step = 0.1;
constexpr int most_angles = 64;
constexpr int most_scales = 9;

// A pose is at least this far from its surroundings, and as much of its contour fired around it.
constexpr double least_z = 2;
constexpr double least_fired_share = 0.2;

// Poses nearer than this to each other are one.
constexpr int same_cells = 6;
constexpr double same_rad = 0.3;

// To tell of a place whether a pose may be there is so much less than to look at one.
constexpr int places_per_pose = 2;

}  // namespace

CoarseSearch::CoarseSearch(const std::vector<Eigen::Vector2d>& samples_px, double radius_px,
                           double length_px)
    : radius_px_(radius_px), length_px_(length_px) {
    // Those that follow each other lie far from each other: most poses are refused by a few.
    constexpr std::size_t apart = 7;
    for (std::size_t i = 0; i < samples_px.size(); ++i) {
        samples_px_.push_back(samples_px[i * apart % samples_px.size()]);
    }
    best_.reserve(kept + 1);
}

void CoarseSearch::begin(const FiredMap& map, const SearchRange& range) {
    map_ = &map;
    best_.clear();
    spots_.clear();
    stride_ = std::max(1, static_cast<int>(stride_px / map.cell_px()));
    const auto cell = [&](double px, int end) {
        return std::clamp(static_cast<int>(px / map.cell_px()), 0, end);
    };
    const Eigen::Vector2d t = range.around.t_px;
    first_column_ = cell(t.x() - range.reach_px, map.columns() - 1);
    end_column_ = cell(t.x() + range.reach_px, map.columns() - 1) + 1;
    first_row_ = cell(t.y() - range.reach_px, map.rows() - 1);
    end_row_ = cell(t.y() + range.reach_px, map.rows() - 1) + 1;
    lay_out_turns(range);
    turn_ = spot_ = 0;
    row_ = first_row_;
}

void CoarseSearch::lay_out_turns(const SearchRange& range) {
    const double cell_px = map_->cell_px();
    const double middle_rad = theta_rad(range.around.a);
    const double middle_scale = std::sqrt(std::abs(range.around.a(0, 0) * range.around.a(1, 1) -
                                                   range.around.a(0, 1) * range.around.a(1, 0)));
    const double rim_px = std::max(radius_px_ * middle_scale, 4.0);
    const double angle_rad = std::min(range.angle_rad, std::numbers::pi);
    const int angles = std::clamp(static_cast<int>(std::ceil(2 * angle_rad * rim_px / rim_step_px)),
                                  1, most_angles);
    const int scales =
        range.log_scale > 0
            ? std::min(2 * static_cast<int>(std::ceil(range.log_scale / scale_step)) + 1,
                       most_scales)
            : 1;
    const double most_log_scale = scales == 1 ? 0 : range.log_scale;
    // What is farther from a place than the image is wide is beyond it, wherever.
    const double rim_cells = radius_px_ * middle_scale * std::exp(most_log_scale) / cell_px + 1;
    margin_columns_ = std::min(static_cast<int>(rim_cells), map_->columns());
    margin_rows_ = std::min(static_cast<int>(rim_cells), map_->rows());
    copy_near();
    turns_.clear();
    for (int s = 0; s < scales; ++s) {
        const double log_scale = scales == 1 ? 0 : most_log_scale * (2.0 * s / (scales - 1) - 1);
        for (int i = 0; i < angles; ++i) {
            Turn turn;
            turn.angle_rad = middle_rad - angle_rad + (i + 0.5) * 2 * angle_rad / angles;
            turn.scale = middle_scale * std::exp(log_scale);
            const Eigen::Matrix2d a = turn.scale * rotation(turn.angle_rad);
            for (std::size_t k = 0; k < samples_px_.size(); ++k) {
                const Eigen::Vector2d d = a * samples_px_[k] / cell_px;
                const auto within = [](double cells, int margin) {
                    return static_cast<int>(std::clamp<double>(std::round(cells), -margin, margin));
                };
                turn.offset[k] =
                    within(d.y(), margin_rows_) * near_columns_ + within(d.x(), margin_columns_);
            }
            turns_.push_back(turn);
        }
    }
}

void CoarseSearch::copy_near() {
    near_columns_ = end_column_ - first_column_ + 2 * margin_columns_;
    const int rows = end_row_ - first_row_ + 2 * margin_rows_;
    near_.resize(static_cast<std::size_t>(near_columns_) * static_cast<std::size_t>(rows));
    for (int i = 0; i < rows; ++i) {
        map_->copy_row(
            first_row_ - margin_rows_ + i, first_column_ - margin_columns_,
            {&near_[static_cast<std::size_t>(i) * static_cast<std::size_t>(near_columns_)],
             static_cast<std::size_t>(near_columns_)});
    }
}

void CoarseSearch::step(int& poses) {
    while (poses > 0 && !is_done()) {
        if (row_ < end_row_) {
            find_spots_in_row();
            row_ += stride_;
            poses -= 1 + (end_column_ - first_column_) / stride_ / places_per_pose;
            continue;
        }
        const Turn& turn = turns_[turn_];
        for (; poses > 0 && spot_ < spots_.size(); --poses) look_at(turn, spots_[spot_++]);
        if (spot_ < spots_.size()) return;
        spot_ = 0;
        ++turn_;
        if (is_done() || turns_[turn_].scale == turn.scale) continue;
        spots_.clear();
        row_ = first_row_;
    }
}

void CoarseSearch::find_spots_in_row() {
    const double scale = turns_[turn_].scale;
    const int half_side = static_cast<int>(0.8 * radius_px_ * scale / map_->cell_px()) + 2;
    const double least_fired = least_fired_share * length_px_ * scale;
    for (int column = first_column_; column < end_column_; column += stride_) {
        const auto around = map_->around(column, row_, half_side);
        if (around.fired * map_->cell_px() < least_fired) continue;
        const double deviation = std::sqrt(std::max(around.variance, 1.0) / points);
        if (around.mean - least_z * deviation > 0) {
            spots_.push_back({column, row_, around.mean, deviation});
        }
    }
}

void CoarseSearch::look_at(const Turn& turn, const Spot& spot) {
    const double wanted_z = best_.size() < kept ? least_z : std::max(least_z, best_.back().z);
    const double most = (spot.mean - wanted_z * spot.deviation) * points;
    if (!(most > 0)) return;
    const int bound = static_cast<int>(most);
    const std::uint8_t* const here =
        &near_[static_cast<std::size_t>((spot.row - first_row_ + margin_rows_) * near_columns_ +
                                        spot.column - first_column_ + margin_columns_)];
    // (Some at a time: the processor does not wait for whether it was enough.)
    constexpr std::size_t at_once = 6;
    int sum = 0;
    for (std::size_t k = 0; k < points; k += at_once) {
        for (std::size_t i = k; i < k + at_once; ++i) sum += here[turn.offset[i]];
        if (sum > bound) return;
    }
    keep({(spot.mean - static_cast<double>(sum) / points) / spot.deviation, turn_, spot.column,
          spot.row});
}

void CoarseSearch::keep(const Candidate& candidate) {
    const auto is_same = [&](const Candidate& other) {
        const double turned = std::remainder(
            turns_[other.turn].angle_rad - turns_[candidate.turn].angle_rad, 2 * std::numbers::pi);
        return std::abs(other.column - candidate.column) <= same_cells &&
               std::abs(other.row - candidate.row) <= same_cells && std::abs(turned) < same_rad;
    };
    const auto is_less = [&](const Candidate& other) { return other.z < candidate.z; };
    const auto place = std::find_if(best_.begin(), best_.end(), is_less);
    if (std::any_of(best_.begin(), place, is_same)) return;
    best_.erase(std::remove_if(best_.insert(place, candidate) + 1, best_.end(), is_same),
                best_.end());
    if (best_.size() > kept) best_.pop_back();
}

Pose CoarseSearch::pose(std::size_t i) const {
    const Candidate& candidate = best_[i];
    const Turn& turn = turns_[candidate.turn];
    Pose pose;
    pose.t_px << (candidate.column + 0.5) * map_->cell_px() - 0.5,
        (candidate.row + 0.5) * map_->cell_px() - 0.5;
    pose.a = turn.scale * rotation(turn.angle_rad);
    return pose;
}

}  // namespace pursuit::tracker
