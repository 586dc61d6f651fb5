// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/occlusion.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace pursuit::tracker {
namespace {

constexpr std::int64_t every_us = 2'000;
constexpr double memory_s = 0.5;

// A contour this deep inside another is told from the other's own.
constexpr double told_depth_px = 2.5;

// How deep a place of the image lies inside a track's contour, image px.
double image_depth_px(const Track& front, const Eigen::Vector2d& p) {
    return front.silhouette().depth_px(p, front.pose());
}

}  // namespace

bool Occlusion::may_overlap(const Round& one, const Round& other) {
    const double reach_px = one.radius_px + other.radius_px + band_px;
    return (one.t_px - other.t_px).squaredNorm() < reach_px * reach_px;
}

void Occlusion::restart() {
    next_us_ = 0;
    last_us_ = -1;
    evidence_.clear();
    overlaps_.clear();
    hidden_by_.clear();
    behind_.clear();
}

void Occlusion::look(std::int64_t t_us, std::span<Track> tracks) {
    const double dt_s = last_us_ < 0 ? 0 : static_cast<double>(t_us - last_us_) * 1e-6;
    last_us_ = t_us;
    next_us_ = t_us + every_us;
    const double kept = std::exp(-dt_s / memory_s);
    for (auto& [pair, evidence] : evidence_) evidence.fade(kept);

    overlaps_.clear();
    fronts_.clear();
    for (std::size_t k = 0; k < tracks.size(); ++k) {
        if (tracks[k].can_hide()) fronts_.push_back(k);
    }
    // (Where nobody can hide another, nobody needs to know where they are.)
    const bool may_any_overlap = tracks.size() > 1 && !fronts_.empty();
    if (may_any_overlap) note_rounds(tracks);
    for (std::size_t i = 0; i < tracks.size(); ++i) {
        const std::size_t before = overlaps_.size();
        if (may_any_overlap && tracks[i].can_be_hidden()) {
            for (const std::size_t k : fronts_) {
                if (i != k && may_overlap(rounds_[i], rounds_[k])) overlaps_.push_back({i, k});
            }
        }
        tracks[i].tally(t_us, overlaps_.size() > before);
    }
    for (const auto& [i, k] : overlaps_) gather(tracks[i], tracks[k]);
    hidden_by_.resize(tracks.size());
    for (auto& fronts : hidden_by_) fronts.clear();
    behind_.clear();
    for (const auto& [i, k] : overlaps_) {
        if (!is_behind(tracks[i], tracks[k])) continue;
        hidden_by_[i].push_back(k);
        behind_.emplace_back(tracks[i].object_id(), tracks[k].object_id());
    }
    std::erase_if(evidence_, [&](const auto& of_pair) {
        return of_pair.second.is_faded() && !holds(of_pair.first);
    });
    for (std::size_t i = 0; i < tracks.size(); ++i) {
        Track& track = tracks[i];
        track.end_tally(t_us);
        if (hidden_by_[i].empty() && !track.is_partly_hidden()) continue;
        for (Outline::Part& part : track.outline().parts()) {
            const Eigen::Vector2d p = track.pose().t_px + track.pose().a * part.middle_px;
            part.is_hidden =
                std::any_of(hidden_by_[i].begin(), hidden_by_[i].end(),
                            [&](std::size_t k) { return image_depth_px(tracks[k], p) > -band_px; });
        }
        track.see(t_us);
    }
}

void Occlusion::note_rounds(std::span<const Track> tracks) {
    rounds_.clear();
    for (const Track& track : tracks) {
        const Pose pose = track.pose();
        rounds_.push_back({pose.t_px, track.contour().radius_px() * largest_scale(pose.a)});
    }
}

// Those that stand still tell nothing, and are as they were. Each behind the other they cannot be.
bool Occlusion::holds(const Pair& pair) const {
    const auto was_found = [&](const Pair& order) {
        return std::binary_search(behind_.begin(), behind_.end(), order);
    };
    return was_found(pair) && !was_found({pair.second, pair.first});
}

void Occlusion::gather(const Track& one, const Track& other) {
    OverlapEvidence& evidence = evidence_[{one.object_id(), other.object_id()}];
    const Pose pose = one.pose();
    for (const Outline::Part& part : one.outline().parts()) {
        const Eigen::Vector2d arm = pose.a * part.middle_px;
        if (image_depth_px(other, pose.t_px + arm) < told_depth_px) continue;
        evidence.add(one.expected_events(part, arm), part.events);
    }
}

bool Occlusion::is_behind(const Track& one, const Track& other) {
    const double depth = one.depth_order();
    const double other_depth = other.depth_order();
    if (depth > 0 && other_depth > 0 && depth != other_depth) return other_depth < depth;

    const auto found = evidence_.find({one.object_id(), other.object_id()});
    if (found == evidence_.end()) return false;
    const auto reverse = evidence_.find({other.object_id(), one.object_id()});
    return found->second.decide(reverse == evidence_.end() ? OverlapEvidence() : reverse->second);
}

bool Occlusion::is_hidden(std::size_t index, const Event& event,
                          std::span<const Track> tracks) const {
    return std::any_of(hidden_by_[index].begin(), hidden_by_[index].end(), [&](std::size_t k) {
        return image_depth_px(tracks[k], Eigen::Vector2d(event.x, event.y)) > -band_px;
    });
}

}  // namespace pursuit::tracker
