// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/extraction/thinning.hpp"

#include <algorithm>
#include <limits>

namespace pursuit::ctl {
namespace {

constexpr float least_spacing_px = 1;
constexpr float corner_reach_px = 4;
constexpr float corner_share = 0.2F;  // of the strongest corner's measure: weaker ones are edges

float squared_distance(const EdgePoint& l, const EdgePoint& r) {
    return (l.position_px - r.position_px).squaredNorm();
}

bool is_apart(const EdgePoint& point, const std::vector<EdgePoint>& others, float spacing_px) {
    return std::none_of(others.begin(), others.end(), [&](const EdgePoint& other) {
        return other.polarity == point.polarity &&
               squared_distance(other, point) < spacing_px * spacing_px;
    });
}

std::vector<EdgePoint> corners_of(std::span<const EdgePoint> points, std::size_t most) {
    std::vector<const EdgePoint*> by_corner;
    float strongest = 0;
    for (const auto& point : points) {
        by_corner.push_back(&point);
        strongest = std::max(strongest, point.corner);
    }
    std::stable_sort(by_corner.begin(), by_corner.end(),
                     [](const auto* l, const auto* r) { return l->corner > r->corner; });
    std::vector<EdgePoint> corners;
    for (const auto* point : by_corner) {
        if (corners.size() >= most || point->corner <= corner_share * strongest) break;
        if (is_apart(*point, corners, corner_reach_px)) corners.push_back(*point);
    }
    return corners;
}

/// Corners, then points by rank, no two nearer than the spacing; stops beyond `most`.
std::vector<EdgePoint> spread(const std::vector<EdgePoint>& corners,
                              std::span<const EdgePoint> points, float spacing_px,
                              std::size_t most) {
    auto chosen = corners;
    for (const auto& point : points) {
        if (chosen.size() > most) break;
        if (is_apart(point, chosen, spacing_px)) chosen.push_back(point);
    }
    return chosen;
}

/// Adds the points that are farthest from all chosen ones, one by one: a spacing that gives too few
/// is next to one that gives too many.
void fill_gaps(std::vector<EdgePoint>& chosen, std::span<const EdgePoint> points,
               std::size_t most) {
    std::vector<float> gaps(points.size(), std::numeric_limits<float>::infinity());
    const auto note = [&](const EdgePoint& added) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (points[i].polarity != added.polarity) continue;
            gaps[i] = std::min(gaps[i], squared_distance(points[i], added));
        }
    };
    for (const auto& point : chosen) note(point);
    while (chosen.size() < most) {
        const auto widest = std::max_element(gaps.begin(), gaps.end());
        if (*widest < least_spacing_px * least_spacing_px) return;
        chosen.push_back(points[static_cast<std::size_t>(widest - gaps.begin())]);
        note(chosen.back());
    }
}

}  // namespace

std::vector<EdgePoint> thin(std::span<const EdgePoint> points, std::size_t most) {
    if (points.empty() || most == 0) return {};
    const auto corners = corners_of(points, most / 4);
    auto chosen = spread(corners, points, least_spacing_px, most);
    if (chosen.size() <= most) return chosen;
    float too_close_px = least_spacing_px;
    float far_px = 2 * least_spacing_px;
    while ((chosen = spread(corners, points, far_px, most)).size() > most) far_px *= 2;
    constexpr int halvings = 12;
    for (int i = 0; i < halvings; ++i) {
        const float middle_px = (too_close_px + far_px) / 2;
        auto trial = spread(corners, points, middle_px, most);
        if (trial.size() > most) {
            too_close_px = middle_px;
        } else {
            far_px = middle_px;
            chosen = std::move(trial);
        }
    }
    fill_gaps(chosen, points, most);
    return chosen;
}

}  // namespace pursuit::ctl
