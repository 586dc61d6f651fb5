// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/evaluation/paper_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/ctl/evaluation/interpolation.hpp"

namespace pursuit::ctl {
namespace {

constexpr std::int64_t window_us = 200;
constexpr double gate_px = 6;
constexpr std::size_t at_most_events = 300'000;

struct NearEvent {
    float x, y;
    std::int64_t window;
    std::array<float, 6> pose;
};

/// Poses at distinct times.
struct Distinct {
    std::vector<double> t_us;
    std::vector<PoseNumbers> poses;
};

Distinct distinct(std::span<const double> t_us, std::span<const PoseNumbers> poses) {
    Distinct kept;
    for (std::size_t i = 0; i < t_us.size(); ++i) {
        if (!kept.t_us.empty() && kept.t_us.back() == t_us[i]) continue;
        kept.t_us.push_back(t_us[i]);
        kept.poses.push_back(poses[i]);
    }
    return kept;
}

/// Distance to the nearest model point, in single precision: a guide to what counts as near.
double nearest_px(const NearEvent& event, const std::vector<Eigen::Vector2f>& model) {
    float best = std::numeric_limits<float>::infinity();
    const auto& p = event.pose;
    for (const auto& m : model) {
        const float dx = event.x - p[0] - p[2] * m.x() - p[3] * m.y();
        const float dy = event.y - p[1] - p[4] * m.x() - p[5] * m.y();
        best = std::min(best, dx * dx + dy * dy);
    }
    return std::sqrt(best);
}

PaperError mean_of_windows(const std::vector<std::pair<std::int64_t, double>>& near) {
    PaperError error;
    error.events = near.size();
    std::vector<double> means;
    for (std::size_t begin = 0; begin < near.size();) {
        double sum = 0;
        std::size_t end = begin;
        while (end < near.size() && near[end].first == near[begin].first) sum += near[end++].second;
        means.push_back(sum / static_cast<double>(end - begin));
        begin = end;
    }
    const auto count = static_cast<double>(means.size());
    for (const double mean : means) error.mean_px += mean / count;
    double square = 0;
    for (const double mean : means) square += (mean - error.mean_px) * (mean - error.mean_px);
    error.sigma_px = std::sqrt(square / count);
    return error;
}

}  // namespace

std::optional<PaperError> paper_error(std::span<const Event> events, std::span<const double> t_us,
                                      std::span<const PoseNumbers> poses, const ModelPoints& model,
                                      double from_us, double to_us, double fresh_us) {
    if (t_us.size() < 2) return std::nullopt;
    const auto known = distinct(t_us, poses);
    std::optional<PoseCurve> curve;
    if (known.t_us.size() > 2) curve.emplace(known.t_us, known.poses);
    double extent_px = 0;
    std::vector<Eigen::Vector2f> model_f;
    for (const auto& point : model) {
        extent_px = std::max(extent_px, point.cwiseAbs().maxCoeff());
        model_f.push_back(point.cast<float>());
    }
    const double reach_px = gate_px + 1 + extent_px * std::sqrt(2) * 1.7;

    std::vector<NearEvent> close;
    for (const auto& event : events) {
        const auto t = static_cast<double>(event.t_us);
        if (t < from_us || t >= to_us) continue;
        const auto window = event.t_us / window_us + 1;
        const auto end_us = static_cast<double>(window * window_us);
        const std::size_t after = std::max<std::size_t>(count_up_to(known.t_us, end_us), 1);
        const std::size_t i = after - 1;
        const std::size_t next = std::min(after, known.t_us.size() - 1);
        const bool is_fresh = known.t_us[next] - known.t_us[i] <= fresh_us;
        const auto pose = is_fresh && curve ? curve->at(end_us) : known.poses[i];
        if (std::hypot(event.x - pose[0], event.y - pose[1]) >= reach_px) continue;
        NearEvent kept{static_cast<float>(event.x), static_cast<float>(event.y), window, {}};
        for (std::size_t k = 0; k < pose.size(); ++k) kept.pose[k] = static_cast<float>(pose[k]);
        close.push_back(kept);
    }

    const auto stride =
        static_cast<std::int64_t>(std::max<std::size_t>(1, close.size() / at_most_events));
    std::vector<std::pair<std::int64_t, double>> near;
    for (const auto& event : close) {
        if (event.window % stride != 0) continue;
        const double distance_px = nearest_px(event, model_f);
        if (distance_px < gate_px) near.emplace_back(event.window, distance_px);
    }
    if (near.empty()) return std::nullopt;
    return mean_of_windows(near);
}

}  // namespace pursuit::ctl
