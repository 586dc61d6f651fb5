// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/where_to_look.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pursuit::tracker {
namespace {

// px, rad and log scale either way.
constexpr double check_reach_px = 30;
constexpr double check_angle_rad = 0.5;
constexpr double uncertain_share = 0.1;  // of the way gone unseen
constexpr double near_reach_px = 30;
constexpr double farthest_reach_px = 80;
constexpr double near_angle_rad = 0.6;
constexpr double near_log_scale = 0.1;
constexpr double near_distance_px = 20;
constexpr std::array stretches{0.75, 0.87, 1.15, 1.33};
constexpr double any_log_scale = 0.27;
constexpr double any_distance_px = 1e6;
constexpr double uncertain_share_of_lost = 0.3;
constexpr double adrift_px = 150;
constexpr double adrift_px_s = 300;

// Of what a check finds.
constexpr double same_px = 2.5;
constexpr double least_told = 0.45;       // score
constexpr double extracted_margin = 0.2;  // of score; for models extracted from a recording

double speed_px_s(const Velocity& v) { return std::hypot(v.vx_px_s, v.vy_px_s); }

}  // namespace

SearchRange range_of_check(std::int64_t t_us, const Coast& own, const Doubt& doubt,
                           const Pose& known, double coast_s) {
    SearchRange range;
    range.checked = own;
    range.around = own.pose;
    range.seeds = {own.pose};
    range.is_check = true;
    range.since_us = doubt.since_us();
    range.reach_px = check_reach_px;
    range.angle_rad = doubt.is_angle_open() ? std::numbers::pi : check_angle_rad;
    range.usual_distance_px = check_reach_px / 2;
    // By turns: as it is thought to go, and as if nothing were known.
    const bool leads_on = doubt.tries() % 2 == 0;
    if (leads_on) range.going = own;
    if (doubt.before()) {
        const Coast gone = doubt.before()->at(t_us, coast_s);
        range.seeds.push_back(gone.pose);
        range.seeds.push_back(doubt.before()->pose);
        if (leads_on) {
            range.going = gone;
            range.around = gone.pose;
        }
        const double gone_s = static_cast<double>(t_us - doubt.before()->t_us) * 1e-6;
        range.angle_rad += uncertain_share * gone_s * std::abs(gone.velocity.omega_rad_s);
        range.reach_px += uncertain_share * gone_s * speed_px_s(gone.velocity);
    }
    if (!leads_on) {
        range.around.a = rotation(theta_rad(own.pose.a) - theta_rad(known.a)) * known.a;
    }
    return range;
}

std::vector<Pose> stretched_poses(const Contour& contour, const Pose& own) {
    Eigen::Array2d least = Eigen::Array2d::Zero();
    Eigen::Array2d most = least;
    for (const Piece& piece : contour.pieces().pieces()) {
        for (const Eigen::Array2d& m :
             {Eigen::Array2d(piece.ax, piece.ay), Eigen::Array2d(piece.bx, piece.by)}) {
            least = least.min(m);
            most = most.max(m);
        }
    }
    std::vector<Pose> poses;
    for (int axis = 0; axis < 2; ++axis) {
        for (const double by : stretches) {
            for (const double end_px : {least(axis), 0.0, most(axis)}) {
                Pose pose = own;
                pose.a.col(axis) *= by;
                pose.t_px += (own.a.col(axis) - pose.a.col(axis)) * end_px;
                poses.push_back(pose);
            }
        }
    }
    return poses;
}

Doubt::Finding compare(const Contour& contour, const std::optional<ShapeSearch::Found>& found,
                       const Pose& checked, double own_score) {
    Doubt::Finding finding;
    finding.is_told = found.has_value();
    if (!found) return finding;
    finding.off_px = found->pose.t_px - checked.t_px;
    const double turned_px =
        contour.gyration_px() * (found->pose.a - checked.a).norm() / std::numbers::sqrt2;
    finding.is_here = std::hypot(finding.off_px.norm(), turned_px) < same_px;
    finding.is_sure = found->is_sure;
    // What was extracted from a recording fits in part only, wherever it is.
    const bool is_worth_it = found->score > least_told;
    finding.is_told = found->is_sure || (is_worth_it && (contour.is_outline() || finding.is_here));
    finding.gain = found->score - own_score - (contour.is_outline() ? 0 : extracted_margin);
    return finding;
}

SearchRange range_near(const Coast& coasted, double gap_s, bool has_fixed_scale) {
    SearchRange range;
    range.around = coasted.pose;
    const double way_px = uncertain_share_of_lost * gap_s * speed_px_s(coasted.velocity);
    range.reach_px = std::min(near_reach_px + way_px, farthest_reach_px);
    range.angle_rad =
        near_angle_rad + uncertain_share_of_lost * gap_s * std::abs(coasted.velocity.omega_rad_s);
    range.log_scale = has_fixed_scale ? 0 : near_log_scale;
    range.usual_distance_px = near_distance_px;
    return range;
}

SearchRange range_of_image(const Pose& around, Geometry geometry, bool has_fixed_scale) {
    SearchRange range;
    range.around = around;
    range.around.t_px << geometry.width / 2.0, geometry.height / 2.0;
    range.reach_px = std::max(geometry.width, geometry.height);
    range.angle_rad = std::numbers::pi;
    range.log_scale = has_fixed_scale ? 0 : any_log_scale;
    range.usual_distance_px = any_distance_px;
    return range;
}

SearchRange range_adrift(const Pose& last, double adrift_s, Geometry geometry,
                         bool has_fixed_scale) {
    SearchRange range = range_of_image(last, geometry, has_fixed_scale);
    range.around = last;
    range.reach_px = std::min(range.reach_px, adrift_px + adrift_px_s * adrift_s);
    range.usual_distance_px = adrift_px;
    return range;
}

}  // namespace pursuit::tracker
